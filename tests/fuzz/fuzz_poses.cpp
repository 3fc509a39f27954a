// poses.csv on arbitrary bytes; whatever is accepted must come back from what is written of it.
#include "input_file.hpp"
#include "polar/core/so3.hpp"
#include "polar/results/pose_table.hpp"
#include "smlm/error.hpp"

namespace {
// A pose is held as a matrix, so a quaternion comes back to its last digits only.
constexpr double kSameAngle = 1e-7;  // rad

bool same(const polar::PoseRow& a, const polar::PoseRow& b) {
  if (a.particle != b.particle || a.reason != b.reason || a.accepted != b.accepted ||
      a.n_localisations != b.n_localisations || a.n_used != b.n_used ||
      a.template_from_view.has_value() != b.template_from_view.has_value())
    return false;
  return !a.template_from_view ||
         (a.template_from_view->translation == b.template_from_view->translation &&
          polar::geodesic_angle(a.template_from_view->rotation, b.template_from_view->rotation) < kSameAngle);
}
}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    const auto rows = polar::read_pose_table(input_file(data, size, ".csv"));
    const std::string text = format_pose_table(rows);
    const auto* bytes = reinterpret_cast<const std::uint8_t*>(text.data());
    const auto again = polar::read_pose_table(input_file(bytes, text.size(), ".written.csv"));
    require(rows.size() == again.size());
    for (std::size_t i = 0; i < rows.size(); ++i) require(same(rows[i], again[i]));
  } catch (const smlm::Error&) {
  }
  return 0;
}
