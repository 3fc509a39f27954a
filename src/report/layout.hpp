// The page's templates (src/report/templates, embedded at build time) and the engine that fills them:
// Mustache, which escapes every text that is not marked as markup.
#pragma once

#include <kainjow/mustache.hpp>
#include <map>
#include <string>

namespace polar::report {

using Data = kainjow::mustache::data;

/// The embedded files, by name.
const std::map<std::string, std::string>& embedded_texts();

/// The one of that name.
const std::string& template_text(const std::string& name);

/// The template of that name with `data` in it. A template that cannot be parsed is a fault of this program.
std::string filled(const std::string& name, const Data& data);

/// An empty list to push to.
inline Data list() { return Data(Data::type::list); }

}  // namespace polar::report
