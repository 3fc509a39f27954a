#include "scale_bar.hpp"

#include <cmath>
#include <cstdio>

namespace polar::results {

double round_length(double most) {
  const double power = std::pow(10.0, std::floor(std::log10(most)));
  for (const double step : {5.0, 2.0})
    if (step * power <= most) return step * power;
  return power;
}

std::string length_label(double nm) {
  char text[32];
  if (nm >= 1000)
    std::snprintf(text, sizeof text, "%g um", nm / 1000);
  else
    std::snprintf(text, sizeof text, "%g nm", nm);
  return text;
}

}  // namespace polar::results
