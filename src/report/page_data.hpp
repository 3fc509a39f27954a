// Sections as the templates want them; shared by the page of a run and that of a batch.
#pragma once

#include <string>
#include <vector>

#include "layout.hpp"
#include "section.hpp"

namespace polar::report {

/// Head (the title with `kind` behind it), style and sections.
Data page_data(const std::string& title, const std::string& kind, const std::vector<Section>& sections);

/// Texts as a list.
Data text_list(const std::vector<std::string>& texts);

}  // namespace polar::report
