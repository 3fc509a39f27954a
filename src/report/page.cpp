#include "polar/report/page.hpp"

#include "embedded_data.hpp"
#include "layout.hpp"
#include "page_data.hpp"
#include "section.hpp"
#include "smlm/atomic_file.hpp"
#include "text.hpp"
#include "verdict.hpp"

namespace polar {

namespace {
using namespace report;

const char* word_of(const std::string& state) {
  return state == "found" ? "Structure found" : state == "none" ? "No structure found" : "Ambiguous";
}

Data numbers_data(const RunRecord& record) {
  Data numbers = list();
  for (const KeyNumber& n : key_numbers(record)) {
    Data number;
    number.set("name", n.name);
    number.set("value", utf8(n.value));
    number.set("note", utf8(n.note));
    numbers.push_back(number);
  }
  return numbers;
}

std::vector<Section> sections_of(const Subject& s) {
  return {average_section(s), rings_section(s),   resolution_section(s), directions_section(s),
          scores_section(s),  gallery_section(s), labelling_section(s),  uncertainties_section(s),
          search_section(s),  again_section(s)};
}
}  // namespace

std::string report_page(const RunRecord& record, const std::string& name) {
  const Subject subject(record);
  const report::Verdict v = verdict(record);
  Data page = page_data(name, "polar", sections_of(subject));
  page.set("state", v.state);
  page.set("word", word_of(v.state));
  page.set("sentence", utf8(v.sentence));
  page.set("program", utf8(record.result.program));
  page.set("numbers", numbers_data(record));
  page.set("has_warnings", !v.warnings.empty());
  page.set("warnings", text_list(v.warnings));
  page.set("configuration", utf8(record.result.configuration));
  page.set("turntable", turntable_json(subject));
  page.set("can_turn", subject.points.size() > 0 && !subject.points.planar);
  page.set("cannot_turn", subject.points.planar
                              ? "The data are planar: there is nothing to turn."
                              : "No particle has a pose, so there is no superparticle to turn.");
  std::size_t left_out = 0;
  page.set("particles", particle_table_json(record, left_out));
  page.set("left_out", left_out == 0 ? std::string()
                                     : std::to_string(left_out) + " more particles are in poses.csv only.");
  page.set("script", template_text("table.js") + template_text("page.js"));
  return filled("page.html", page);
}

void write_report(const std::string& results_h5, const std::string& html, const std::string& name) {
  smlm::write_file_atomically(html, report_page(read_run_record(results_h5), name));
}

}  // namespace polar
