#include "modes_tables.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>

#include "results/csv_line.hpp"

namespace polar::pipeline {

namespace {
using fitting::Mode;
using fitting::ModesReport;
using results::csv_length;
using results::csv_number;

void each_mode(const ModesReport& r, const std::function<void(const Mode&, bool, std::size_t)>& visit) {
  for (std::size_t m = 0; m < r.position.size(); ++m) visit(r.position[m], true, m + 1);
  for (std::size_t m = 0; m < r.occupancy_mode.size(); ++m) visit(r.occupancy_mode[m], false, m + 1);
}

const char* kind_of(bool position) { return position ? "position" : "occupancy"; }
}  // namespace

const std::vector<double>& shown_scores() {
  static const std::vector<double> kScores = {-2, 0, 2};
  return kScores;
}

Eigen::Matrix3Xd sites_at(const ModesReport& report, const Mode& mode, double score) {
  return report.site_nm + score * mode.field;
}

std::string modes_csv(const ModesReport& r) {
  std::string text =
      "kind,mode,rms,control_rms,above_noise,share,reliability,gain,gain_std,radial_share,axial_share\n";
  each_mode(r, [&](const Mode& m, bool position, std::size_t number) {
    text += std::string(kind_of(position)) + "," + std::to_string(number) + "," +
            csv_number(std::sqrt(m.variance)) + "," + csv_number(std::sqrt(m.control)) + "," +
            (m.above_noise ? "1" : "0") + "," + csv_number(m.share) + "," + csv_number(m.reliability) + ",";
    if (position)
      text += csv_number(m.gain) + "," + csv_number(m.gain_std) + "," + csv_number(m.radial) + "," +
              csv_number(m.axial) + "\n";
    else
      text += ",,,\n";
  });
  return text;
}

std::string scores_csv(const ModesReport& r, const std::vector<std::string>& particle) {
  std::string text = "particle";
  each_mode(r, [&](const Mode&, bool position, std::size_t number) {
    const std::string name = std::string(kind_of(position)) + "_" + std::to_string(number);
    text += "," + name + "," + name + "_std";
  });
  text += "\n";
  for (std::size_t p = 0; p < particle.size(); ++p) {
    text += results::csv_field(particle[p]);
    each_mode(r, [&](const Mode& m, bool, std::size_t) {
      const auto row = static_cast<Eigen::Index>(p);
      text += "," + csv_number(m.score[row]) + "," + csv_number(m.score_std[row]);
    });
    text += "\n";
  }
  return text;
}

std::string mode_sites_csv(const ModesReport& r) {
  std::string text = "kind,mode,score,site,x_nm,y_nm,z_nm,occupancy\n";
  each_mode(r, [&](const Mode& m, bool position, std::size_t number) {
    for (const double score : shown_scores()) {
      const Eigen::Matrix3Xd place = position ? sites_at(r, m, score) : r.site_nm;
      for (Eigen::Index k = 0; k < place.cols(); ++k) {
        const double moved = r.occupancy[k] + (position ? 0 : score * m.field(0, k));
        text += std::string(kind_of(position)) + "," + std::to_string(number) + "," + csv_number(score) +
                "," + std::to_string(k + 1) + ",";
        for (int a = 0; a < 3; ++a) text += csv_length(place(a, k)) + ",";
        text += csv_number(std::clamp(moved, 0.0, 1.0)) + "\n";
      }
    }
  });
  return text;
}

nlohmann::json modes_json(const ModesReport& r) {
  nlohmann::json modes = nlohmann::json::array();
  each_mode(r, [&](const Mode& m, bool position, std::size_t number) {
    nlohmann::json j = {{"kind", kind_of(position)},
                        {"mode", number},
                        {"unit", position ? "nm" : "1"},
                        {"rms", std::sqrt(m.variance)},
                        {"control_rms", std::sqrt(m.control)},
                        {"above_noise", m.above_noise},
                        {"share", m.share},
                        {"reliability", m.reliability}};
    if (position) {
      j["gain"] = m.gain, j["gain_std"] = m.gain_std;
      j["radial_share"] = m.radial, j["axial_share"] = m.axial;
    }
    modes.push_back(j);
  });
  return {{"sites", r.site_nm.cols()},
          {"label_width_nm", r.width_nm},
          {"background_share", r.background},
          {"modes", modes}};
}

std::vector<std::string> modes_lines(const ModesReport& r) {
  std::vector<std::string> lines;
  char line[240];
  each_mode(r, [&](const Mode& m, bool position, std::size_t number) {
    const int length =
        std::snprintf(line, sizeof line, "%-9s %zu  rms %.3g%s (control %.3g)", kind_of(position), number,
                      std::sqrt(m.variance), position ? " nm" : "", std::sqrt(m.control));
    char* rest = line + length;
    const std::size_t room = sizeof line - static_cast<std::size_t>(length);
    if (!m.above_noise && position && m.variance > m.control)
      std::snprintf(rest, room, ": not above noise, evidence %+.4f +- %.4f", m.gain, m.gain_std);
    else if (!m.above_noise)
      std::snprintf(rest, room, ": not above noise");
    else if (position)
      std::snprintf(
          rest, room,
          ": share %.2f, scores good for a correlation of %.2f; radius %.0f %%, height %.0f %%; evidence "
          "%+.4f +- %.4f",
          m.share, m.reliability, 100 * m.radial, 100 * m.axial, m.gain, m.gain_std);
    else
      std::snprintf(rest, room, ": share %.2f, scores good for a correlation of %.2f", m.share,
                    m.reliability);
    lines.emplace_back(line);
  });
  return lines;
}

}  // namespace polar::pipeline
