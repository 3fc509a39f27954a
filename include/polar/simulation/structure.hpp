// The structures that can be simulated: where their emitters (sites) sit, in nanometres about the
// structure's centre, with the symmetry axis along z and a two-fold axis (if any) along x.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace polar {

struct Structure {
  std::string name;
  Eigen::Matrix3Xd site_nm;       // 3 x K, structure frame
  std::string symmetry = "none";  // rotations that map the sites onto themselves: none, C9, D8, T, O, ...
  std::vector<std::string> warnings = {};  // what a file of it left open

  /// Largest distance of a site from the structure's centre.
  double radius_nm() const;
};

/// What to build. Lengths that are 0 take the kind's own default (see make_structure).
struct StructureOptions {
  std::string kind = "nuclear_pore";  // nuclear_pore | centriole | tetrahedron | cube | ring
  double radius_nm = 0;               // distance of the sites from the axis (or centre); 0: the kind's own
  double length_nm = 0;               // ring separation or centriole length; 0: the kind's own
  int units = 0;                      // copies about the axis; 0: the kind's own
};

/// One sentence per fault, empty when the options can be used.
std::vector<std::string> violations(const StructureOptions& options);

/// nuclear_pore: two rings of 8 corners with 2 Nup96 each, radius 53.5 nm, rings 50 nm apart, the two
///   proteins of a corner 12 nm apart, the rings turned by 8.8 degrees (J. V. Thevathasan et al., Nuclear
///   pores as versatile reference standards for quantitative superresolution microscopy, Nature Methods
///   16, 1045-1053, 2019). D8.
/// centriole: nine triplets of microtubules (centres 20 nm apart, leaning 50 degrees against the tangent;
///   A-tubules at 85 nm), 400 nm long, a site every 20 nm (sizes after M. Winey and E. O'Toole, Centriole
///   structure, Phil. Trans. R. Soc. B 369:20130457, 2014). C9.
/// tetrahedron, cube: vertices at 43 nm from the centre. T, O.
/// ring: 8 sites at 50 nm. D8 (in the plane C8).
Structure make_structure(const StructureOptions& options);

/// The same structure moved so that the mean of its sites is 0 and scaled to radius_nm (0 keeps the size).
Structure centred(Structure structure, double radius_nm);

}  // namespace polar
