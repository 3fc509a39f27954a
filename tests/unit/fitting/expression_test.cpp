#include "polar/fitting/expression.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

namespace polar::fitting {
namespace {

double value(const std::string& text, double a = 0, double b = 0) {
  return Expression(text, {"a", "b"}).at(std::vector<double>{a, b});
}

std::string fault(const std::string& text) {
  try {
    Expression(text, {"a", "b"});
  } catch (const std::invalid_argument& e) {
    return e.what();
  }
  return "";
}

TEST(Expression, FollowsTheRulesOfArithmetic) {
  EXPECT_DOUBLE_EQ(value("1 + 2 * 3 - 4 / 2"), 5);
  EXPECT_DOUBLE_EQ(value("(1 + 2) * 3"), 9);
  EXPECT_DOUBLE_EQ(value("-a / 2", 6), -3);
  EXPECT_DOUBLE_EQ(value("-a^2", 3), -9);
  EXPECT_DOUBLE_EQ(value("2 - -a", 3), 5);
  EXPECT_DOUBLE_EQ(value("10 - 4 - 3"), 3);
  EXPECT_DOUBLE_EQ(value("1.5e2 + .5"), 150.5);
  EXPECT_DOUBLE_EQ(value("a^-1", 4), 0.25);
  EXPECT_DOUBLE_EQ(value("2 * pi * a^2 * (1 - cos(b * pi / 180))", 10, 90), 200 * std::acos(-1.0));
  EXPECT_DOUBLE_EQ(value("sqrt(abs(0 - 4)) + exp(log(3)) + sin(0) + tan(0)"), 5);
}

TEST(Expression, KnowsWhetherItVaries) {
  EXPECT_TRUE(Expression("2 * pi", {"a"}).is_constant());
  EXPECT_FALSE(Expression("2 * a", {"a"}).is_constant());
}

TEST(Expression, SaysWhatIsWrong) {
  EXPECT_NE(fault("a + c").find("'c' is not known (known: a, b)"), std::string::npos);
  EXPECT_NE(fault("cosine(a)").find("'cosine' is no function"), std::string::npos);
  EXPECT_NE(fault("(a + 1").find("a ')' is missing"), std::string::npos);
  EXPECT_NE(fault("a b").find("'b' is not expected"), std::string::npos);
  EXPECT_NE(fault("a +").find("a number is expected"), std::string::npos);
  EXPECT_NE(fault("").find("a number is expected"), std::string::npos);
  EXPECT_NE(fault(std::string(1000, '(')).find("nested too deeply"), std::string::npos);
}

}  // namespace
}  // namespace polar::fitting
