#include "polar/fitting/expression.hpp"

#include <algorithm>
#include <cctype>
#include <locale>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "polar/core/constants.hpp"

namespace polar::fitting {

// Recursive descent; every rule leaves its value on top of the postfix code's stack.
class ExpressionParser {
 public:
  ExpressionParser(const std::string& text, const std::vector<std::string>& names)
      : text_(text), names_(names) {}

  std::vector<Expression::Step> parse() {
    sum();
    if (peek() != '\0') fail(std::string("'") + peek() + "' is not expected");
    return std::move(code_);
  }

 private:
  using Op = Expression::Op;
  static constexpr int kDeepest = 64;

  [[noreturn]] void fail(const std::string& what) const {
    throw std::invalid_argument("'" + text_ + "': " + what);
  }
  char peek() {
    while (at_ < text_.size() && std::isspace(static_cast<unsigned char>(text_[at_]))) ++at_;
    return at_ < text_.size() ? text_[at_] : '\0';
  }
  bool take(char c) {
    if (peek() != c) return false;
    ++at_;
    return true;
  }
  void emit(Op op, double number = 0, std::size_t name = 0) { code_.push_back({op, number, name}); }

  void sum() {
    if (++depth_ > kDeepest) fail("nested too deeply");
    product();
    while (true) {
      if (take('+'))
        product(), emit(Op::add);
      else if (take('-'))
        product(), emit(Op::subtract);
      else
        break;
    }
    --depth_;
  }
  void product() {
    signed_value();
    while (true) {
      if (take('*'))
        signed_value(), emit(Op::multiply);
      else if (take('/'))
        signed_value(), emit(Op::divide);
      else
        return;
    }
  }
  void signed_value() {
    bool negative = false;
    while (true) {
      if (take('-'))
        negative = !negative;
      else if (!take('+'))
        break;
    }
    value();
    if (take('^')) {
      const bool down = take('-');
      emit(Op::power, (down ? -1 : 1) * number());
    }
    if (negative) emit(Op::negate);
  }
  double number() {
    peek();
    const std::size_t begin = at_;
    while (at_ < text_.size() && (std::isdigit(static_cast<unsigned char>(text_[at_])) || text_[at_] == '.' ||
                                  ((text_[at_] == '+' || text_[at_] == '-') && at_ > begin &&
                                   std::tolower(text_[at_ - 1]) == 'e') ||
                                  (std::tolower(text_[at_]) == 'e' && at_ > begin)))
      ++at_;
    std::istringstream in(text_.substr(begin, at_ - begin));
    in.imbue(std::locale::classic());
    double parsed = 0;
    if (!(in >> parsed) || !in.eof()) fail("a number is expected at character " + std::to_string(begin + 1));
    return parsed;
  }
  void value() {
    const char c = peek();
    if (take('(')) {
      sum();
      if (!take(')')) fail("a ')' is missing");
    } else if (std::isalpha(static_cast<unsigned char>(c)) || c == '_') {
      word();
    } else {
      emit(Op::number, number());
    }
  }
  void word() {
    const std::size_t begin = at_;
    while (at_ < text_.size() && (std::isalnum(static_cast<unsigned char>(text_[at_])) || text_[at_] == '_'))
      ++at_;
    const std::string name = text_.substr(begin, at_ - begin);
    if (peek() == '(') return function(name);
    const auto known = std::find(names_.begin(), names_.end(), name);
    if (known != names_.end()) return emit(Op::name, 0, static_cast<std::size_t>(known - names_.begin()));
    if (name == "pi") return emit(Op::number, kPi);
    std::string list;
    for (const std::string& n : names_) list += (list.empty() ? "" : ", ") + n;
    fail("'" + name + "' is not known (known: " + (list.empty() ? "no name" : list) + ")");
  }
  void function(const std::string& name) {
    static const std::vector<std::pair<std::string, Op>> kFunctions = {
        {"sqrt", Op::sqrt}, {"sin", Op::sin}, {"cos", Op::cos}, {"tan", Op::tan},
        {"exp", Op::exp},   {"log", Op::log}, {"abs", Op::abs}};
    const auto known =
        std::find_if(kFunctions.begin(), kFunctions.end(), [&](const auto& f) { return f.first == name; });
    if (known == kFunctions.end())
      fail("'" + name + "' is no function (known: sqrt, sin, cos, tan, exp, log, abs)");
    take('(');
    sum();
    if (!take(')')) fail("a ')' is missing");
    emit(known->second);
  }

  const std::string& text_;
  const std::vector<std::string>& names_;
  std::size_t at_ = 0;
  int depth_ = 0;
  std::vector<Expression::Step> code_;
};

Expression::Expression(const std::string& text, const std::vector<std::string>& names)
    : code_(ExpressionParser(text, names).parse()) {}

bool Expression::is_constant() const {
  return std::none_of(code_.begin(), code_.end(), [](const Step& s) { return s.op == Op::name; });
}

}  // namespace polar::fitting
