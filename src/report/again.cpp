// What it takes to run it again.
#include "section.hpp"
#include "text.hpp"

namespace polar::report {

namespace {
std::string or_absent(const std::string& text) { return text.empty() ? "not recorded" : text; }
}  // namespace

Section again_section(const Subject& subject) {
  const RunRecord& record = subject.record;
  Section s{"again", "To run it again", {}, {}, {}};
  std::string libraries;
  for (const std::string& l : record.libraries) libraries += (libraries.empty() ? "" : ", ") + l;
  Table table{{"what", "value"},
              {{"command", or_absent(record.command)},
               {"program", or_absent(record.result.program)},
               {"libraries", or_absent(libraries)},
               {"machine", or_absent(record.machine)},
               {"seed", std::to_string(record.seed)},
               {"hash of input and configuration", or_absent(record.result.input_hash)}}};
  if (!record.weights_sha256.empty()) table.rows.push_back({"weights (SHA-256)", record.weights_sha256});
  s.tables.push_back(table);
  Table files{{"input file", "SHA-256"}, {}};
  const bool hashed = !record.input_file.empty();
  const std::vector<std::string>& names = hashed ? record.input_file : record.result.superparticle.files;
  for (std::size_t i = 0; i < names.size(); ++i)
    files.rows.push_back({names[i], hashed ? or_absent(record.input_sha256[i]) : "not recorded"});
  s.tables.push_back(files);
  return s;
}

}  // namespace polar::report
