#include "page_data.hpp"

#include "text.hpp"

namespace polar::report {

namespace {
Data figure_data(const Figure& f) {
  Data figure;
  figure.set("id", utf8(f.id));
  figure.set("title", utf8(f.title));
  figure.set("svg", f.svg);
  figure.set("present", !f.svg.empty());
  figure.set("absent", f.svg.empty());
  figure.set("caption", utf8(f.caption));
  figure.set("has_caption", !f.caption.empty());
  return figure;
}

Data table_data(const Table& t) {
  Data rows = list();
  for (const auto& r : t.rows) {
    Data row;
    row.set("cells", text_list(r));
    rows.push_back(row);
  }
  Data table;
  table.set("heads", text_list(t.heads));
  table.set("rows", rows);
  return table;
}
}  // namespace

Data text_list(const std::vector<std::string>& texts) {
  Data all = list();
  for (const std::string& t : texts) {
    Data one;
    one.set("text", utf8(t));
    all.push_back(one);
  }
  return all;
}

Data page_data(const std::string& title, const std::string& kind, const std::vector<Section>& sections) {
  Data all = list();
  for (const Section& s : sections) {
    Data section, figures = list(), tables = list();
    for (const Figure& f : s.figures) figures.push_back(figure_data(f));
    for (const Table& t : s.tables) tables.push_back(table_data(t));
    section.set("id", s.id);
    section.set("title", s.title);
    section.set("notes", text_list(s.notes));
    section.set("grid", s.tiles ? "figures tiles" : "figures");
    section.set("figures", figures);
    section.set("tables", tables);
    section.set("is_average", s.id == "average");
    section.set("is_again", s.id == "again");
    all.push_back(section);
  }
  Data page;
  page.set("title", utf8(title));
  page.set("kind", kind);
  page.set("head", template_text("head.html"));
  page.set("style", template_text("style.css"));
  page.set("sections", all);
  page.set("section_list", template_text("sections.html"));
  return page;
}

}  // namespace polar::report
