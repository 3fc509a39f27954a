// What a page is made of: sections of sentences, figures and tables.
#pragma once

#include <string>
#include <vector>

#include "frame.hpp"
#include "polar/report/record.hpp"

namespace polar::report {

/// A picture, or the reason why there is none.
struct Figure {
  std::string id, title;
  std::string svg;      // empty: absent
  std::string caption;  // below it; of an absent figure the reason
};

inline Figure absent(std::string id, std::string title, std::string why) {
  return {std::move(id), std::move(title), {}, std::move(why)};
}

struct Table {
  std::vector<std::string> heads;
  std::vector<std::vector<std::string>> rows;
};

struct Section {
  std::string id, title;
  std::vector<std::string> notes;
  std::vector<Figure> figures;
  std::vector<Table> tables;
  bool tiles = false;  // small figures, many in a row
};

/// A record and its superparticle in the frame that the page draws.
struct Subject {
  const RunRecord& record;
  DrawingFrame frame;
  smlm::LocalisationTable points;  // drawn frame

  explicit Subject(const RunRecord& r);
};

// One function a section, in the order of the page. Each is in the source of its name.
Section average_section(const Subject& subject);
Section rings_section(const Subject& subject);
Section resolution_section(const Subject& subject);
Section directions_section(const Subject& subject);
Section scores_section(const Subject& subject);
Section gallery_section(const Subject& subject);
Section labelling_section(const Subject& subject);
Section uncertainties_section(const Subject& subject);
Section search_section(const Subject& subject);
Section again_section(const Subject& subject);

}  // namespace polar::report
