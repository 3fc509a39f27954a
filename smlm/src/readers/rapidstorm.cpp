// rapidSTORM text: the first line is "# <localizations ...>" with one XML <field> per column; blanks separate
// the fields. Where the element nests another one (tracks), each line goes on with a count and that many
// inner localisations: the outer fields, the track's means, are read.
#include "../text/text_table.hpp"
#include "readers.hpp"
#include "smlm/error.hpp"

namespace smlm::readers {
namespace {

constexpr std::string_view element = "<localizations";

bool recognises(const FileHead& head) {
  return !head.hdf5 && head.bytes.substr(0, 200).find(element) != std::string::npos;
}

// The value of `name="..."` inside one tag; empty when absent.
std::string attribute(std::string_view tag, std::string_view name) {
  const std::string key = " " + std::string(name) + "=\"";
  const auto start = tag.find(key);
  if (start == std::string_view::npos) return {};
  const auto from = start + key.size();
  const auto end = tag.find('"', from);
  return end == std::string_view::npos ? std::string() : std::string(tag.substr(from, end - from));
}

std::optional<Quantity> role(const std::string& identifier) {
  static const std::vector<std::pair<std::string_view, Quantity>> roles{
      {"Position-0-0", Quantity::x},
      {"Position-1-0", Quantity::y},
      {"Position-2-0", Quantity::z},
      {"Position-0-0-uncertainty", Quantity::sigma_x},
      {"Position-1-0-uncertainty", Quantity::sigma_y},
      {"Position-2-0-uncertainty", Quantity::sigma_z},
      {"ImageNumber-0-0", Quantity::frame},
      {"Amplitude-0-0", Quantity::photons},
      {"LocalBackground-0-0", Quantity::background}};
  for (const auto& [name, quantity] : roles) {
    if (name == identifier) return quantity;
  }
  return Quantity::other;
}

// The fields of the outer element.
std::vector<SourceColumn> outer_fields(std::string_view xml) {
  const auto first = xml.find(element);
  xml.remove_prefix(first == std::string_view::npos ? xml.size() : first + element.size());
  xml = xml.substr(0, xml.find(element));  // a second one is nested
  std::vector<SourceColumn> columns;
  for (auto at = xml.find("<field"); at != std::string_view::npos; at = xml.find("<field", at + 1)) {
    const std::string_view tag = xml.substr(at, xml.find('>', at) - at);
    const std::string identifier = attribute(tag, "identifier");
    columns.push_back({identifier, attribute(tag, "unit"), role(identifier)});
  }
  return columns;
}

LocalisationTable read(const std::string& path, const ReadOptions& options) {
  TextFormat format;
  format.ignore_further_fields = true;
  format.columns = [&path](const TextHeader& header, ReadOptions&) {
    for (const std::string& comment : header.comments) {
      auto columns = outer_fields(comment);
      if (!columns.empty()) return columns;
    }
    throw Error(Fault::input, path, "has no '# <localizations>' line that names its fields",
                "export it again");
  };
  return read_text_table(path, options, format);
}

}  // namespace

const TableReader rapidstorm{"rapidstorm", "rapidSTORM (.txt)", recognises, read};

}  // namespace smlm::readers
