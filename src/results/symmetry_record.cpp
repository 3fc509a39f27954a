#include "symmetry_record.hpp"

#include <string>
#include <vector>

namespace polar {

void write_symmetry(smlm::h5::File& file, const Symmetry& s, double scale_nm) {
  file.make_group("/symmetry");
  file.write_string_attribute("/symmetry", "group", s.group);
  file.write_attribute("/symmetry", "imposed", static_cast<std::uint8_t>(s.in_use ? 1 : 0));
  file.write_attribute("/symmetry", "asked", static_cast<std::uint8_t>(s.asked ? 1 : 0));
  file.write_string_attribute("/symmetry", "convention", "x_canonical = rotation (x_template - centre)");
  file.write_attribute("/symmetry", "held_out_gain", s.gain);
  file.write_attribute("/symmetry", "held_out_gain_std", s.gain_std);
  const Eigen::Matrix3d& r = s.canonical_from_template.rotation;
  std::vector<double> rotation, unit, similarity, gain, gain_std;
  for (Eigen::Index i = 0; i < 3; ++i)
    for (Eigen::Index j = 0; j < 3; ++j) rotation.push_back(r(i, j));
  const Eigen::Vector3d centre = scale_nm * s.centre();
  file.write("/symmetry/rotation", rotation, {3, 3});
  file.write("/symmetry/centre_nm", std::vector<double>(centre.data(), centre.data() + 3));
  for (Eigen::Index k = 0; k < s.unit.cols(); ++k)
    for (Eigen::Index a = 0; a < 3; ++a) unit.push_back(scale_nm * s.unit(a, k));
  file.write("/symmetry/unit_nm", unit, {static_cast<std::size_t>(s.unit.cols()), 3});
  file.write("/symmetry/unit_share", s.unit_share);
  std::vector<std::string> group;
  for (const SymmetryTrial& t : s.tried) {
    group.push_back(t.group);
    similarity.push_back(t.similarity), gain.push_back(t.gain), gain_std.push_back(t.gain_std);
  }
  file.write_strings("/symmetry/tried/group", group);
  file.write("/symmetry/tried/similarity", similarity);
  file.write("/symmetry/tried/held_out_gain", gain);
  file.write("/symmetry/tried/held_out_gain_std", gain_std);
}

}  // namespace polar
