// Arithmetic in model files: "distance / 2", "2 * pi * radius^2 * (1 - cos(opening * pi / 180))".
#pragma once

#include <cmath>
#include <string>
#include <vector>

namespace polar::fitting {

/// A formula of named values. Grammar: numbers, names, pi, + - * / ^ (a whole or broken constant power),
/// parentheses, and sqrt, sin, cos, tan, exp, log, abs of radians and numbers.
class Expression {
 public:
  Expression() : Expression(0.0) {}
  explicit Expression(double constant) : code_{{Op::number, constant, 0}} {}

  /// Throws std::invalid_argument with a sentence that says what is wrong; `names` are the known values.
  Expression(const std::string& text, const std::vector<std::string>& names);

  bool is_constant() const;

  /// `value`: of the names, in their order. For double and for types with derivatives (ceres::Jet).
  template <class T>
  T at(const std::vector<T>& value) const;

 private:
  friend class ExpressionParser;
  enum class Op {
    number,
    name,
    add,
    subtract,
    multiply,
    divide,
    negate,
    power,
    sqrt,
    sin,
    cos,
    tan,
    exp,
    log,
    abs
  };
  struct Step {
    Op op;
    double number;     // of number and power (the exponent)
    std::size_t name;  // of name
  };
  std::vector<Step> code_;  // postfix
};

template <class T>
T Expression::at(const std::vector<T>& value) const {
  using std::abs, std::cos, std::exp, std::log, std::pow, std::sin, std::sqrt, std::tan;
  std::vector<T> stack;
  const auto pop = [&] {
    T top = stack.back();
    stack.pop_back();
    return top;
  };
  for (const Step& step : code_) {
    if (step.op == Op::number) {
      stack.push_back(T(step.number));
    } else if (step.op == Op::name) {
      stack.push_back(value[step.name]);
    } else {
      const T b = pop();
      switch (step.op) {
        case Op::add:
          stack.push_back(pop() + b);
          break;
        case Op::subtract:
          stack.push_back(pop() - b);
          break;
        case Op::multiply:
          stack.push_back(pop() * b);
          break;
        case Op::divide:
          stack.push_back(pop() / b);
          break;
        case Op::negate:
          stack.push_back(-b);
          break;
        case Op::power:
          stack.push_back(pow(b, step.number));
          break;
        case Op::sqrt:
          stack.push_back(sqrt(b));
          break;
        case Op::sin:
          stack.push_back(sin(b));
          break;
        case Op::cos:
          stack.push_back(cos(b));
          break;
        case Op::tan:
          stack.push_back(tan(b));
          break;
        case Op::exp:
          stack.push_back(exp(b));
          break;
        case Op::log:
          stack.push_back(log(b));
          break;
        default:
          stack.push_back(abs(b));
          break;
      }
    }
  }
  return stack.back();
}

}  // namespace polar::fitting
