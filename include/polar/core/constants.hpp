// Mathematical constants; angles are radians inside, degrees only where a name says so.
#pragma once

namespace polar {

constexpr double kPi = 3.14159265358979323846;
constexpr double kTwoPi = 2 * kPi;
constexpr float kTwoPiF = static_cast<float>(kTwoPi);
constexpr double kGoldenAngle = 2.399963229728653;  // pi (3 - sqrt 5)
constexpr double kRadiansPerDegree = kPi / 180.0;
constexpr double kDegreesPerRadian = 180.0 / kPi;

}  // namespace polar
