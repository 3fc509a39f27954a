// Whether localisations scatter as much as their table says.
#include <algorithm>
#include <array>
#include <cmath>

#include "plot.hpp"
#include "polar/core/constants.hpp"
#include "polar/core/covariance3.hpp"
#include "polar/core/median.hpp"
#include "section.hpp"
#include "text.hpp"

namespace polar::report {

namespace {
constexpr std::size_t kMostResiduals = 4000;
constexpr double kOutlier = 4;  // sigma: farther from every site is no residual but an outlier
constexpr double kNormalOfMad = 1.4826;
constexpr double kReach = 4, kBins = 32;

double found(double stated_nm, double factor, double extra_nm) {
  return std::hypot(factor * stated_nm, extra_nm);
}

// Standard deviations across and along the optical axis of a localisation's own particle, as stated.
std::array<double, 2> stated_nm(const RunRecord& record, std::size_t row) {
  const smlm::LocalisationTable& t = record.result.superparticle;
  const Eigen::Matrix3d& r =
      record.poses[static_cast<std::size_t>(t.particle[row])].template_from_view->rotation;
  const Eigen::Matrix3d in_view = r.transpose() * matrix(t.covariance_nm2[row]) * r;
  return {std::sqrt(std::max(0.0, (in_view(0, 0) + in_view(1, 1)) / 2)),
          std::sqrt(std::max(0.0, in_view(2, 2)))};
}

bool has_pose(const RunRecord& record, std::size_t row) {
  const std::int64_t particle = record.result.superparticle.particle[row];
  return particle >= 0 && record.poses[static_cast<std::size_t>(particle)].template_from_view.has_value();
}

struct Residuals {
  std::vector<double> stated_lateral_nm, stated_axial_nm;
  std::vector<double> lateral, axial;  // in units of the effective sigma and the site's width together
  std::size_t outliers = 0;
};

// Every localisation against the site that most probably made it.
Residuals residuals_of(const RunRecord& record) {
  const smlm::LocalisationTable& t = record.result.superparticle;
  const TemplateSites& sites = record.result.sites;
  const RenderOptions& c = record.result.render;
  Residuals out;
  const std::size_t stride = t.size() / kMostResiduals + 1;
  for (std::size_t i = 0; i < t.size(); i += stride) {
    if (!has_pose(record, i)) continue;
    const auto [lateral_nm, axial_nm] = stated_nm(record, i);
    out.stated_lateral_nm.push_back(lateral_nm);
    if (!t.planar) out.stated_axial_nm.push_back(axial_nm);
    const double s = std::hypot(found(lateral_nm, c.lateral_factor, c.lateral_extra_nm), sites.width_nm),
                 sz = std::hypot(found(axial_nm, c.axial_factor, c.axial_extra_nm), sites.width_nm);
    const Eigen::Matrix3d view_from_template =
        record.poses[static_cast<std::size_t>(t.particle[i])].template_from_view->rotation.transpose();
    const Eigen::Vector3d x(t.position_nm[i][0], t.position_nm[i][1], t.position_nm[i][2]);
    double best = -1e300;
    Eigen::Vector3d residual = Eigen::Vector3d::Constant(1e9);
    for (Eigen::Index k = 0; k < sites.centre_nm.cols(); ++k) {
      Eigen::Vector3d d = view_from_template * (x - sites.centre_nm.col(k));
      d = Eigen::Vector3d(d.x() / s, d.y() / s, t.planar ? 0 : d.z() / sz);
      const double score = std::log(std::max(sites.weight[k], 1e-300)) - d.squaredNorm() / 2;
      if (score > best) best = score, residual = d;
    }
    if (residual.norm() > kOutlier) {
      ++out.outliers;
      continue;
    }
    out.lateral.push_back(residual.x());
    out.lateral.push_back(residual.y());
    if (!t.planar) out.axial.push_back(residual.z());
  }
  return out;
}

double robust_std(const std::vector<double>& values) {
  if (values.empty()) return PoseRow::kNone;
  const double middle = upper_median(values);
  std::vector<double> distance;
  for (const double v : values) distance.push_back(std::abs(v - middle));
  return kNormalOfMad * upper_median(distance);
}

Figure residual_figure(const char* id, const std::string& title, const std::vector<double>& values) {
  if (values.empty()) return absent(id, title, "There are no residuals of this kind.");
  const Histogram h = histogram_between(values, -kReach, kReach, static_cast<std::size_t>(kBins));
  std::vector<double> x, normal;
  for (double v = -kReach; v <= kReach; v += 0.1) {
    x.push_back(v);
    normal.push_back(static_cast<double>(h.total) * h.width * std::exp(-v * v / 2) / std::sqrt(kTwoPi));
  }
  const double top =
      std::max(static_cast<double>(h.highest()), *std::max_element(normal.begin(), normal.end()));
  Plot plot({-kReach, kReach, "residual [sigma]"}, {0, 1.08 * top, "count"});
  plot.bars("c1", h);
  plot.line("c2", x, normal);
  plot.legend({{"c1", "found"}, {"c2", "normal"}});
  return {id, title, plot.svg(title),
          "Robust standard deviation " + digits(robust_std(values)) +
              " (1: as the run takes the uncertainties to be). Narrower where sites stand denser than the "
              "uncertainty: the nearest is always near."};
}
}  // namespace

Section uncertainties_section(const Subject& subject) {
  Section s{"uncertainties", "Uncertainties", {}, {}, {}};
  const RunRecord& record = subject.record;
  const Residuals r = residuals_of(record);
  if (r.stated_lateral_nm.empty()) {
    s.figures.push_back(absent("calibration", "Stated against found", "No particle has a pose."));
    return s;
  }
  const RenderOptions& c = record.result.render;
  std::vector<double> sigma = r.stated_lateral_nm;
  sigma.insert(sigma.end(), r.stated_axial_nm.begin(), r.stated_axial_nm.end());
  const double last = 1.15 * quantile(sigma, 0.99);
  std::vector<double> x, lateral, axial;
  for (int k = 0; k <= 60; ++k) {
    x.push_back(last * k / 60);
    lateral.push_back(found(x.back(), c.lateral_factor, c.lateral_extra_nm));
    axial.push_back(found(x.back(), c.axial_factor, c.axial_extra_nm));
  }
  double top = last;
  for (const double v : lateral) top = std::max(top, v);
  if (!subject.points.planar)
    for (const double v : axial) top = std::max(top, v);
  Plot plot({0, last, "stated [nm]"}, {0, top, "found [nm]"});
  plot.line("faint", {0, last}, {0, last});
  plot.line("c1", x, lateral);
  if (!subject.points.planar) plot.line("c2", x, axial);
  plot.legend(subject.points.planar
                  ? std::vector<std::pair<std::string, std::string>>{{"c1", "lateral"}}
                  : std::vector<std::pair<std::string, std::string>>{{"c1", "lateral"}, {"c2", "axial"}});
  s.figures.push_back({"calibration", "Stated against found", plot.svg("stated against found uncertainties"),
                       "found^2 = factor^2 stated^2 + extra^2. Grey: as stated."});
  const double stated = upper_median(r.stated_lateral_nm);
  Table table{{"", "stated, median [nm]", "factor", "extra [nm]", "found, median [nm]"},
              {{"lateral", digits(stated), digits(c.lateral_factor), digits(c.lateral_extra_nm),
                digits(found(stated, c.lateral_factor, c.lateral_extra_nm))}}};
  s.figures.push_back(residual_figure("residual-lateral", "Lateral residuals", r.lateral));
  if (!r.stated_axial_nm.empty()) {
    const double stated_axial = upper_median(r.stated_axial_nm);
    table.rows.push_back({"axial", digits(stated_axial), digits(c.axial_factor), digits(c.axial_extra_nm),
                          digits(found(stated_axial, c.axial_factor, c.axial_extra_nm))});
    s.figures.push_back(residual_figure("residual-axial", "Axial residuals", r.axial));
  } else {
    s.figures.push_back(absent("residual-axial", "Axial residuals", "The data are planar."));
  }
  if (r.outliers > 0)
    s.notes.push_back(
        percent(static_cast<double>(r.outliers) / static_cast<double>(r.stated_lateral_nm.size()), 1) +
        " of the localisations lie more than " + digits(kOutlier, 1) +
        " sigma from every site: outliers, left out of the residuals.");
  s.tables.push_back(table);
  return s;
}

}  // namespace polar::report
