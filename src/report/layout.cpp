#include "layout.hpp"

#include <stdexcept>

namespace polar::report {

std::string filled(const std::string& name, const Data& data) {
  kainjow::mustache::mustache parsed(template_text(name));
  if (!parsed.is_valid()) throw std::logic_error(name + ": " + parsed.error_message());
  return parsed.render(data);
}

}  // namespace polar::report
