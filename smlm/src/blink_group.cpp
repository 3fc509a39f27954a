#include "smlm/blink_group.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

#include "smlm/error.hpp"
#include "smlm/kept_column.hpp"
#include "table_rows.hpp"

namespace smlm {
namespace {

struct Reach {
  double size = 0;
  bool in_sigmas = false;
};

std::optional<Reach> parse_distance(const std::string& text) {
  Reach reach;
  const auto parsed = std::from_chars(text.data(), text.data() + text.size(), reach.size);
  if (parsed.ec != std::errc() || !(reach.size > 0 && reach.size < 1e6)) return std::nullopt;
  const std::string unit(parsed.ptr, text.data() + text.size());
  if (unit != " nm" && unit != "nm" && unit != " sigma") return std::nullopt;
  reach.in_sigmas = unit == " sigma";
  return reach;
}

using Symmetric = std::array<double, 6>;  // xx xy xz yy yz zz

Symmetric inverse(const Symmetric& m) {
  const Symmetric adjugate = {m[3] * m[5] - m[4] * m[4], m[2] * m[4] - m[1] * m[5],
                              m[1] * m[4] - m[2] * m[3], m[0] * m[5] - m[2] * m[2],
                              m[1] * m[2] - m[0] * m[4], m[0] * m[3] - m[1] * m[1]};
  const double determinant = m[0] * adjugate[0] + m[1] * adjugate[1] + m[2] * adjugate[2];
  Symmetric result = adjugate;
  for (double& element : result) element /= determinant;
  return result;
}

std::array<double, 3> times(const Symmetric& m, const std::array<double, 3>& x) {
  return {m[0] * x[0] + m[1] * x[1] + m[2] * x[2], m[1] * x[0] + m[3] * x[1] + m[4] * x[2],
          m[2] * x[0] + m[4] * x[1] + m[5] * x[2]};
}

// Rows in the order of frames, and within each frame also of x, so that neighbours are found.
class Frames {
 public:
  Frames(const LocalisationTable& table, const std::vector<double>& frame) : table_(table), frame_(frame) {
    order_.resize(table.size());
    std::iota(order_.begin(), order_.end(), 0U);
    std::stable_sort(order_.begin(), order_.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return frame[a] < frame[b]; });
    by_x_ = order_;
    std::sort(by_x_.begin(), by_x_.end(), [&](std::uint32_t a, std::uint32_t b) {
      if (frame[a] != frame[b]) return frame[a] < frame[b];
      return x(a) != x(b) ? x(a) < x(b) : a < b;
    });
  }

  const std::vector<std::uint32_t>& order() const { return order_; }

  /// The lowest row of the first later frame, up to `last`, that `fits` among those with x within `reach_nm`.
  template <class Fits>
  std::optional<std::uint32_t> next(std::uint32_t row, double last, double reach_nm, const Fits& fits) const {
    double frame = frame_[row];
    while (true) {
      const auto later = std::upper_bound(by_x_.begin(), by_x_.end(), frame,
                                          [&](double f, std::uint32_t r) { return f < frame_[r]; });
      if (later == by_x_.end() || frame_[*later] > last) return std::nullopt;
      frame = frame_[*later];
      auto it = std::lower_bound(later, by_x_.end(), x(row) - reach_nm, [&](std::uint32_t r, double least) {
        return frame_[r] == frame && x(r) < least;
      });
      std::optional<std::uint32_t> first;
      for (; it != by_x_.end() && frame_[*it] == frame && x(*it) <= x(row) + reach_nm; ++it)
        if ((!first || *it < *first) && fits(*it)) first = *it;
      if (first) return first;
    }
  }

 private:
  double x(std::uint32_t row) const { return table_.position_nm[row][0]; }

  const LocalisationTable& table_;
  const std::vector<double>& frame_;
  std::vector<std::uint32_t> order_, by_x_;
};

double square(double v) { return v * v; }

bool near(const LocalisationTable& t, const Reach& reach, std::uint32_t a, std::uint32_t b) {
  const auto &p = t.position_nm[a], &q = t.position_nm[b];
  const double lateral = square(p[0] - q[0]) + square(p[1] - q[1]);
  if (!reach.in_sigmas) return lateral <= square(reach.size);
  const auto &c = t.covariance_nm2[a], &d = t.covariance_nm2[b];
  const double k = square(reach.size);
  return lateral <= k * (square(lateral_sigma_nm(c)) + square(lateral_sigma_nm(d))) &&
         (t.planar || square(p[2] - q[2]) <= k * (static_cast<double>(c[5]) + static_cast<double>(d[5])));
}

using Chain = std::vector<std::uint32_t>;

std::vector<Chain> find_chains(const LocalisationTable& table, const std::vector<double>& frame,
                               const Reach& reach, int dark_frames) {
  double widest_nm = 0;
  for (const Covariance& c : table.covariance_nm2) widest_nm = std::max(widest_nm, lateral_sigma_nm(c));
  std::vector<bool> taken(table.size(), false);
  std::vector<Chain> chains;
  const Frames frames(table, frame);
  for (const std::uint32_t start : frames.order()) {
    if (taken[start]) continue;
    Chain chain;
    for (std::optional<std::uint32_t> row = start; row;) {
      chain.push_back(*row);
      taken[*row] = true;
      const std::uint32_t here = *row;
      const double reach_nm =
          reach.in_sigmas ? reach.size * std::hypot(lateral_sigma_nm(table.covariance_nm2[here]), widest_nm)
                          : reach.size;
      row = frames.next(here, frame[here] + dark_frames + 1, reach_nm, [&](std::uint32_t other) {
        return !taken[other] && table.particle[other] == table.particle[here] &&
               near(table, reach, here, other);
      });
    }
    chains.push_back(std::move(chain));
  }
  return chains;
}

// The chain's localisation, put where its first one stands.
void merge_positions(LocalisationTable& table, const Chain& chain) {
  Symmetric information{};
  std::array<double, 3> sum{};
  for (const std::uint32_t row : chain) {
    const Covariance& c = table.covariance_nm2[row];
    const Symmetric weight = inverse(Symmetric{c[0], c[1], c[2], c[3], c[4], c[5]});
    const std::array<double, 3> weighted = times(weight, table.position_nm[row]);
    for (std::size_t i = 0; i < 6; ++i) information[i] += weight[i];
    for (std::size_t i = 0; i < 3; ++i) sum[i] += weighted[i];
  }
  const Symmetric covariance = inverse(information);
  table.position_nm[chain.front()] = times(covariance, sum);
  for (std::size_t i = 0; i < 6; ++i)
    table.covariance_nm2[chain.front()][i] = static_cast<float>(covariance[i]);
}

void merge_column(ExtraColumn& column, const std::vector<Chain>& chains, bool summed) {
  for (const Chain& chain : chains) {
    double sum = 0, n = 0;
    for (const std::uint32_t row : chain) {
      if (std::isnan(column.values[row])) continue;
      sum += column.values[row];
      n += 1;
    }
    if (n > 0) column.values[chain.front()] = summed ? sum : sum / n;
  }
}

}  // namespace

std::vector<std::string> violations(const BlinkOptions& options) {
  std::vector<std::string> faults;
  if (!options.distance.empty() && !parse_distance(options.distance))
    faults.push_back("distance: '" + options.distance + "' is neither like '2 sigma' nor like '20 nm'");
  if (options.dark_frames < 0) faults.emplace_back("dark_frames: must be 0 or more");
  return faults;
}

void merge_blinks(LocalisationTable& table, const BlinkOptions& options) {
  const std::optional<Reach> reach = parse_distance(options.distance);
  if (!reach) return;
  const ExtraColumn* frame = find_column(table, Quantity::frame);
  if (frame == nullptr)
    throw Error(Fault::input, table.files.empty() ? "input.group" : table.files.front(),
                "has no frames, by which input.group merges localisations",
                "leave input.group.distance empty");
  std::vector<double> frames = frame->values;
  for (double& f : frames)
    if (!std::isfinite(f))
      f = -std::numeric_limits<double>::infinity();  // follows nothing, nothing follows it
  const std::vector<Chain> chains = find_chains(table, frames, *reach, options.dark_frames);
  const ExtraColumn* photons = find_column(table, Quantity::photons);
  const ExtraColumn* background = find_column(table, Quantity::background);
  for (const Chain& chain : chains)
    if (chain.size() > 1) merge_positions(table, chain);
  std::vector<std::uint32_t> firsts;
  std::vector<double> merged;
  for (const Chain& chain : chains) {
    firsts.push_back(chain.front());
    merged.push_back(static_cast<double>(chain.size()));
  }
  for (ExtraColumn& column : table.extra)
    if (column.labels.empty() && &column != frame)
      merge_column(column, chains, &column == photons || &column == background);
  const std::size_t before = table.size();
  take_rows(table, firsts);
  table.extra.push_back({"merged", "", std::move(merged), {}});
  table.mapping.push_back("merged <- " + std::to_string(before) + " localisations into " +
                          std::to_string(table.size()) + " (" + options.distance + ", " +
                          std::to_string(options.dark_frames) + " dark frames)");
}

}  // namespace smlm
