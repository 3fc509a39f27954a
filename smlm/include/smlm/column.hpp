// The column registry: what each quantity is called, in which unit it is kept, what it means, and under
// which names other programs write it.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "smlm/units.hpp"

namespace smlm {

enum class Quantity {
  x,
  y,
  z,
  sigma_x,
  sigma_y,
  sigma_z,
  sigma_lateral,  // standard deviations
  sigma_xx,
  sigma_xy,
  sigma_xz,
  sigma_yy,
  sigma_yz,
  sigma_zz,  // a full covariance
  particle,
  frame,
  photons,
  background,
  other  // kept, not used
};

/// What a column of uncertainties holds.
enum class Spread { standard_deviation, variance };

/// How plainly a name claims its quantity; a plainer claim wins.
enum class Claim {
  weak,    // only when no other column claims the quantity, and said: a bare "sigma"
  likely,  // "sigma_x": beside an uncertainty by name it is the width of the PSF
  plain
};

/// A name that some program gives to a quantity. Names are compared in lower case, with blanks and
/// hyphens as underscores, without unit. Names of uncertainties that are made of words ("X_loc_error",
/// "error_x", "var_z") need no alias: see uncertainty_named().
struct Alias {
  std::string_view name;
  std::string_view unit = {};  // what the name itself implies; empty: it implies none
};

struct ColumnSpec {
  Quantity quantity;
  std::string_view name;     // canonical: the key under `input.columns`
  std::string_view unit;     // the internal one
  std::string_view meaning;  // one line
  std::vector<Alias> aliases;
};

/// Every quantity that is read, in the order of Quantity.
const std::vector<ColumnSpec>& column_registry();

/// The specification of a quantity; `other` has none and must not be asked for.
const ColumnSpec& column_spec(Quantity quantity);

/// The quantity with this canonical name; "sigma_xy" is the lateral standard deviation, and the off-diagonal
/// element of a covariance only where sigma_xx is mapped beside it.
std::optional<Quantity> quantity_named(std::string_view canonical_name);

/// A header cell taken apart: "X precision (nm)" -> name "x_precision", unit "nm"; "x_nm" likewise.
struct Heading {
  std::string name;  // normalised as in Alias
  std::string unit;  // as written, empty when the cell says nothing
};
Heading parse_heading(std::string_view cell);

/// A column that some alias claims.
struct ColumnMatch {
  Quantity quantity = Quantity::other;
  std::string unit;  // from the header or the alias; empty when neither says
  Claim claim = Claim::plain;
  Spread spread = Spread::standard_deviation;
};
std::optional<ColumnMatch> match_heading(const Heading& heading);

/// A name made of words for an uncertainty (precision, error, crlb, std, var, sigma, ...), an axis (x, y, z,
/// xy, lateral, axial) and what goes without saying (loc, position, a unit): what it is an uncertainty of.
std::optional<ColumnMatch> uncertainty_named(const std::string& normalised_name);

/// Whether some word of the name speaks of an uncertainty, whatever else it says.
bool sounds_like_uncertainty(const std::string& normalised_name);

}  // namespace smlm
