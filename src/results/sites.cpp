#include "polar/results/sites.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "background.hpp"
#include "csv_line.hpp"
#include "emitter.hpp"
#include "label_counts.hpp"
#include "polar/core/constants.hpp"
#include "polar/core/covariance3.hpp"
#include "polar/core/median.hpp"
#include "polar/core/parallel.hpp"
#include "polar/core/rng.hpp"

namespace polar {

namespace {
constexpr double kFaintest = 0.12;  // of the highest maximum: a label on one particle in eight is seen
constexpr std::size_t kMostSites = 128;
constexpr std::size_t kMostLocalisations = 20000;  // that positions are refined from
constexpr int kMostSteps = 100;
constexpr double kStill_nm = 1e-3;  // a step that changes every centre and width by less ends the refinement
// The same, and what is enough, while sites that are one are still looked for.
constexpr double kNearlyStill_nm = 0.1;
constexpr std::size_t kEnoughLocalisations = 5000;
constexpr double kLeastBackground = 1e-3;
constexpr double kApart = 3;              // standard deviations between sites that are told apart
constexpr double kClearly = 0.7;          // of it: nearer ones are none whatever more localisations say
constexpr double kMostBackground = 0.35;  // share of localisations at no site of a discrete template
constexpr double kHotSpot = 5;            // standard errors
constexpr double kSmallestWidth_nm = 0.1;
constexpr std::uint32_t kSampleStage = 0x84;

using Table = smlm::LocalisationTable;

double median_sigma_nm(const Table& t) {
  std::vector<double> sigma(t.size());
  for (std::size_t i = 0; i < t.size(); ++i) sigma[i] = results::sigma_nm(t, i);
  return upper_median(std::move(sigma));
}

// Voxels that no neighbour exceeds, the highest first.
std::vector<Eigen::Vector3d> maxima(const Volume& v) {
  std::vector<std::pair<float, std::size_t>> found;
  const float highest = *std::max_element(v.density.begin(), v.density.end());
  const auto [nx, ny, nz] = v.size;
  for (std::size_t z = 0; z < nz; ++z)
    for (std::size_t y = 0; y < ny; ++y)
      for (std::size_t x = 0; x < nx; ++x) {
        const float here = v.at(x, y, z);
        if (!(here > kFaintest * highest)) continue;
        bool top = true;
        for (std::size_t w = z - (z > 0); w <= std::min(z + 1, nz - 1) && top; ++w)
          for (std::size_t q = y - (y > 0); q <= std::min(y + 1, ny - 1) && top; ++q)
            for (std::size_t p = x - (x > 0); p <= std::min(x + 1, nx - 1) && top; ++p)
              top = v.at(p, q, w) <= here;
        if (top) found.emplace_back(here, (z * ny + y) * nx + x);
      }
  std::sort(found.begin(), found.end(), [](const auto& a, const auto& b) {
    return a.first != b.first ? a.first > b.first : a.second < b.second;
  });
  std::vector<Eigen::Vector3d> places;
  for (const auto& [value, index] : found)
    places.emplace_back(v.origin_nm[0] + v.voxel_nm * static_cast<double>(index % nx),
                        v.origin_nm[1] + v.voxel_nm * static_cast<double>(index / nx % ny),
                        v.origin_nm[2] + v.voxel_nm * static_cast<double>(index / nx / ny));
  return places;
}

struct Model {
  std::vector<Site> site;
  double background_share = 0.1;
  double background_density = 0;  // nm^-3, planar nm^-2
  bool planar = false;
  int dimensions() const { return planar ? 2 : 3; }
};

results::Emitter emitter(const Model& m, const Eigen::Matrix3d& c, const Eigen::Vector3d& x, std::size_t k) {
  return results::emitter(m.planar, c, x, m.site[k]);
}

// Probability of every site, and at the end of the background, for one localisation.
std::vector<double> belongs_to(const Model& m, const Table& t, std::size_t row,
                               std::vector<results::Emitter>& emitters) {
  const Eigen::Matrix3d c = matrix(t.covariance_nm2[row]);
  const Eigen::Vector3d x(t.position_nm[row].data());
  std::vector<double> p(m.site.size() + 1);
  double sum = p.back() = m.background_share * m.background_density;
  for (std::size_t k = 0; k < m.site.size(); ++k) {
    emitters[k] = emitter(m, c, x, k);
    sum += p[k] = m.site[k].share * emitters[k].density;
  }
  for (double& value : p) value /= sum > 0 ? sum : 1;
  return p;
}

// Sums over localisations that the next step follows from.
struct Sums {
  Eigen::VectorXd weight, square, variance;
  Eigen::Matrix3Xd mean;
  double background = 0;
  explicit Sums(std::size_t n)
      : weight(Eigen::VectorXd::Zero(static_cast<Eigen::Index>(n))),
        square(weight),
        variance(weight),
        mean(Eigen::Matrix3Xd::Zero(3, static_cast<Eigen::Index>(n))) {}
  Sums& operator+=(const Sums& o) {
    weight += o.weight, square += o.square, variance += o.variance, mean += o.mean;
    background += o.background;
    return *this;
  }
};

// One step; returns how far the site that moved most did.
double step(Model& m, const Table& t, const std::vector<std::uint32_t>& rows) {
  constexpr std::size_t kBlock = 256;
  const std::size_t n = m.site.size();
  const Sums all = ordered_sum(rows.size(), kBlock, Sums(n), [&](std::size_t begin, std::size_t end) {
    Sums s(n);
    std::vector<results::Emitter> emitters(n);
    for (std::size_t i = begin; i < end; ++i) {
      const std::vector<double> p = belongs_to(m, t, rows[i], emitters);
      s.background += p.back();
      for (std::size_t k = 0; k < n; ++k) {
        const auto c = static_cast<Eigen::Index>(k);
        s.weight[c] += p[k];
        s.mean.col(c) += p[k] * emitters[k].mean;
        s.square[c] += p[k] * (emitters[k].mean - m.site[k].centre_nm).squaredNorm();
        s.variance[c] += p[k] * emitters[k].variance;
      }
    }
    return s;
  });
  double farthest = 0;
  for (std::size_t k = 0; k < n; ++k) {
    const auto c = static_cast<Eigen::Index>(k);
    Site& s = m.site[k];
    if (!(all.weight[c] > 0)) continue;
    const Eigen::Vector3d centre = all.mean.col(c) / all.weight[c];
    const double moved = (centre - s.centre_nm).norm();
    const double square = all.square[c] / all.weight[c] - moved * moved + all.variance[c] / all.weight[c];
    const double width = std::max(kSmallestWidth_nm, std::sqrt(std::max(0.0, square) / m.dimensions()));
    farthest = std::max({farthest, moved, std::abs(width - s.width_nm)});
    s.centre_nm = centre;
    s.width_nm = width;
    s.share = all.weight[c] / static_cast<double>(rows.size());
  }
  m.background_share = std::max(kLeastBackground, all.background / static_cast<double>(rows.size()));
  return farthest;
}

double nearest_nm(const std::vector<Site>& sites, std::size_t k) {
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t j = 0; j < sites.size(); ++j)
    if (j != k) nearest = std::min(nearest, (sites[j].centre_nm - sites[k].centre_nm).norm());
  return nearest;
}

// Sites that are one: the fainter of two that lie closer than one standard deviation goes.
bool drop_one_of_two(Model& m, double sigma) {
  std::sort(m.site.begin(), m.site.end(), [](const Site& a, const Site& b) { return a.share > b.share; });
  const double faintest = m.site.empty() ? 0 : kFaintest / 2 * m.site.front().share;
  const std::size_t before = m.site.size();
  std::vector<Site> kept;
  for (const Site& s : m.site) {
    const bool apart = std::all_of(kept.begin(), kept.end(), [&](const Site& other) {
      return (s.centre_nm - other.centre_nm).norm() > std::hypot(sigma, std::min(s.width_nm, other.width_nm));
    });
    if (apart && s.share > faintest) kept.push_back(s);
  }
  m.site = std::move(kept);
  return m.site.size() < before;
}

// Why a template with these sites is none of sites; empty: it is one. `slack`: of the distances asked for.
std::string not_discrete(const Model& m, double sigma, double slack) {
  if (m.site.empty() || m.background_share > kMostBackground) return "most of it lies between its maxima";
  for (std::size_t k = 0; k < m.site.size(); ++k)
    if (nearest_nm(m.site, k) < slack * kApart * std::hypot(sigma, m.site[k].width_nm))
      return "its maxima are not far enough apart to be told from one another";
  return {};
}

Model fit(const Table& t, const std::vector<Eigen::Vector3d>& start, const Volume& box, double sigma) {
  Model m;
  m.planar = t.planar;
  double extent = 1;
  for (std::size_t axis = 0; axis < static_cast<std::size_t>(m.dimensions()); ++axis)
    extent *= box.voxel_nm * static_cast<double>(box.size[axis]);
  m.background_density = 1 / extent;
  for (const Eigen::Vector3d& place : start) {
    Site s;
    s.centre_nm = place;
    s.width_nm = sigma / 2;
    s.share = (1 - m.background_share) / static_cast<double>(start.size());
    m.site.push_back(s);
  }
  const std::vector<std::uint32_t> order = random_order(t.size(), KeyedRandom(1, 0, kSampleStage));
  const auto settle = [&](std::size_t most, double still_nm) {
    const std::vector<std::uint32_t> rows(
        order.begin(), order.begin() + static_cast<std::ptrdiff_t>(std::min(most, order.size())));
    do {
      for (int i = 0; i < kMostSteps && step(m, t, rows) > still_nm; ++i) {
      }
    } while (drop_one_of_two(m, sigma));
  };
  settle(kEnoughLocalisations, kNearlyStill_nm);
  if (not_discrete(m, sigma, kClearly).empty()) settle(kMostLocalisations, kStill_nm);
  return m;
}
}  // namespace

DiscreteSites find_sites(const Table& t, const RenderOptions& options) {
  DiscreteSites out;
  out.reason = "there are no localisations";
  if (t.size() == 0) return out;
  const double sigma = median_sigma_nm(t);
  RenderOptions soft = options;
  soft.channel_column.clear();
  soft.voxel_nm = sigma / std::sqrt(2.0);  // half of the width drawn
  soft.lateral_extra_nm = std::hypot(options.lateral_extra_nm, sigma);
  soft.axial_extra_nm = std::hypot(options.axial_extra_nm, sigma);
  const Volume density = render(t, soft);
  const std::vector<Eigen::Vector3d> start = maxima(density);
  out.reason = "its density has more than " + std::to_string(kMostSites) + " maxima";
  if (start.size() > kMostSites) return out;
  Model m = fit(t, start, density, sigma);
  out.reason = not_discrete(m, sigma, 1);
  if (!out.reason.empty()) return out;
  for (Site& s : m.site)
    s.centre_std_nm = std::hypot(sigma, s.width_nm) / std::sqrt(s.share * static_cast<double>(t.size()));
  out.site = m.site;
  out.background_share = m.background_share;
  const auto density_at = [&](const Eigen::Matrix3d& c, const Eigen::Vector3d& x, std::size_t k) {
    return emitter(m, c, x, k).density;
  };
  std::vector<results::Emitter> emitters(m.site.size());
  const double background = results::background_density(
      t, [&](std::size_t row) { return belongs_to(m, t, row, emitters).back(); }, m.background_density);
  out.counts = results::count_labels(results::candidates_of(t, m.site.size(), density_at), m.site.size(),
                                     background, m.background_share);
  for (std::size_t k = 0; k < out.site.size(); ++k) {
    out.site[k].occupancy = out.counts.occupancy[k];
    out.orbit.push_back(k);
  }
  return out;
}

std::string format_sites_csv(const DiscreteSites& sites) {
  std::string text = "x_nm,y_nm,z_nm,centre_std_nm,width_nm,share,occupancy\n";
  for (const Site& s : sites.site) {
    for (int axis = 0; axis < 3; ++axis) text += results::csv_length(s.centre_nm[axis]) + ",";
    text += results::csv_length(s.centre_std_nm) + "," + results::csv_length(s.width_nm) + "," +
            results::csv_number(s.share) + "," + results::csv_number(s.occupancy) + "\n";
  }
  return text;
}

void set_orbits(DiscreteSites& sites, const std::vector<Eigen::Matrix3d>& group,
                const Pose& canonical_from_template) {
  std::vector<Eigen::Vector3d> place;
  for (const Site& s : sites.site) place.push_back(canonical_from_template * s.centre_nm);
  for (std::size_t k = 0; k < place.size(); ++k) {
    const double near_nm = nearest_nm(sites.site, k) / 2;
    for (std::size_t j = 0; j < k && sites.orbit[k] == k; ++j)
      if (std::any_of(group.begin(), group.end(), [&](const Eigen::Matrix3d& turn) {
            return (turn * place[j] - place[k]).norm() < near_nm;
          }))
        sites.orbit[k] = sites.orbit[j];
  }
}

std::vector<std::size_t> hot_spots(const DiscreteSites& sites) {
  const std::size_t n = sites.site.size();
  std::vector<std::size_t> hot;
  const double particles = std::accumulate(sites.counts.particles.begin(), sites.counts.particles.end(), 0.0);
  if (n < 3 || !(particles > 0)) return hot;
  std::vector<double> sum(n, 0.0), members(n, 0.0), occupancy;
  for (std::size_t k = 0; k < n; ++k)
    sum[sites.orbit[k]] += sites.site[k].occupancy, members[sites.orbit[k]] += 1;
  for (std::size_t k = 0; k < n; ++k) occupancy.push_back(sum[sites.orbit[k]] / members[sites.orbit[k]]);
  const double usual = upper_median(occupancy);
  for (std::size_t k = 0; k < n; ++k) {
    const double error =
        std::sqrt(std::max(usual * (1 - usual), 1e-4) / (particles * members[sites.orbit[k]]));
    if (occupancy[k] > usual + kHotSpot * error) hot.push_back(k);
  }
  return hot;
}

}  // namespace polar
