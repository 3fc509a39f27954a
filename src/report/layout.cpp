#include "layout.hpp"

#include <stdexcept>

namespace polar::report {

const std::string& template_text(const std::string& name) {
  const auto found = embedded_texts().find(name);
  if (found == embedded_texts().end()) throw std::logic_error("no template " + name);
  return found->second;
}

std::string filled(const std::string& name, const Data& data) {
  kainjow::mustache::mustache parsed(template_text(name));
  if (!parsed.is_valid()) throw std::logic_error(name + ": " + parsed.error_message());
  return parsed.render(data);
}

}  // namespace polar::report
