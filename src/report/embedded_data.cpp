#include "embedded_data.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "base64.hpp"
#include "channels.hpp"
#include "polar/core/median.hpp"
#include "text.hpp"

namespace polar::report {

namespace {
constexpr std::size_t kMostRows = 20000, kMostPoints = 24000;
constexpr double kHeld = 0.995;  // of the localisations: the farthest do not set the scale
constexpr double kFull = 32767;

nlohmann::json number(double value) { return rounded_json(value, 5); }

void append_int16(std::string& bytes, double share) {
  const auto value = static_cast<std::int16_t>(std::lround(kFull * std::clamp(share, -1.0, 1.0)));
  const auto bits = static_cast<std::uint16_t>(value);
  bytes += static_cast<char>(bits & 0xff);
  bytes += static_cast<char>(bits >> 8);
}
}  // namespace

nlohmann::json rounded_json(double value, int significant) {
  if (!std::isfinite(value)) return nullptr;
  return std::strtod(digits(value, significant).c_str(), nullptr);
}

std::string script_json(const nlohmann::json& value) {
  const std::string text = value.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  std::string safe;
  for (const char c : text) {
    if (c == '<')
      safe += "\\u003c";
    else
      safe += c;
  }
  return safe;
}

std::string particle_table_json(const RunRecord& record, std::size_t& left_out) {
  nlohmann::json heads = nlohmann::json::array(), rows = nlohmann::json::array();
  const auto head = [&](const char* name, bool is_number) {
    heads.push_back({{"name", name}, {"number", is_number}});
  };
  head("line", true), head("particle", false), head("localisations", true), head("used", true);
  head("accepted", false), head("log likelihood", true), head("margin", true), head("rotation [deg]", true);
  head("place [nm]", true), head("visibility", true), head("outliers", true), head("reason", false);
  const std::size_t n = std::min(record.poses.size(), kMostRows);
  left_out = record.poses.size() - n;
  for (std::size_t i = 0; i < n; ++i) {
    const PoseRow& p = record.poses[i];
    rows.push_back({i + 1, p.particle, p.n_localisations, p.n_used, p.accepted ? "yes" : "no",
                    number(p.log_likelihood), number(p.margin), number(p.rotation_std_deg),
                    number(p.translation_std_nm), number(record.fit[i].visibility),
                    number(record.fit[i].outlier_fraction), p.reason});
  }
  return script_json({{"heads", heads}, {"rows", rows}});
}

std::string turntable_json(const Subject& subject) {
  const smlm::LocalisationTable& t = subject.points;
  nlohmann::json out = {{"n", 0}};
  if (t.size() == 0 || t.planar) return script_json(out);
  std::vector<double> distance;
  for (const auto& x : t.position_nm) distance.push_back(std::sqrt(x[0] * x[0] + x[1] * x[1] + x[2] * x[2]));
  const double half_nm = std::max(1e-6, quantile(distance, kHeld));
  const std::vector<Channel> channels = tinted_channels(t, subject.record.channel_column);
  std::string points, channel;
  std::size_t n = 0;
  const std::size_t stride = (t.size() + kMostPoints - 1) / kMostPoints;
  for (std::size_t i = 0; i < t.size(); i += stride) {
    if (distance[i] > half_nm) continue;
    for (const double x : t.position_nm[i]) append_int16(points, x / half_nm);
    std::size_t own = 0;
    while (own + 1 < channels.size() && !channels[own].rows[i]) ++own;
    channel += static_cast<char>(own);
    ++n;
  }
  nlohmann::json tints = nlohmann::json::array();
  for (const Channel& c : channels) tints.push_back(c.tint);
  out = {{"n", n},
         {"half_nm", half_nm},
         {"of", t.size()},
         {"points", base64(points)},
         {"channel", base64(channel)},
         {"tints", channels.size() > 1 ? tints : nlohmann::json::array()}};
  return script_json(out);
}

}  // namespace polar::report
