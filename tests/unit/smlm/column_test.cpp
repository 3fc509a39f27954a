#include "smlm/column.hpp"

#include <gtest/gtest.h>

#include <set>

namespace smlm {
namespace {

TEST(Column, RegistryFollowsTheOrderOfQuantity) {
  for (std::size_t i = 0; i < column_registry().size(); ++i) {
    EXPECT_EQ(static_cast<std::size_t>(column_registry()[i].quantity), i);
    EXPECT_FALSE(column_registry()[i].meaning.empty());
  }
  EXPECT_EQ(column_registry().size(), static_cast<std::size_t>(Quantity::other));
}

TEST(Column, NoAliasNamesTwoQuantities) {
  std::set<std::string_view> seen;
  for (const ColumnSpec& spec : column_registry()) {
    for (const Alias& alias : spec.aliases) EXPECT_TRUE(seen.insert(alias.name).second) << alias.name;
  }
}

TEST(Column, HeadingsComeApartIntoNameAndUnit) {
  const auto check = [](const char* cell, const char* name, const char* unit) {
    const Heading heading = parse_heading(cell);
    EXPECT_EQ(heading.name, name) << cell;
    EXPECT_EQ(heading.unit, unit) << cell;
  };
  check("x [nm]", "x", "nm");
  check("\"uncertainty_xy [nm]\"", "uncertainty_xy", "nm");
  check("X precision (nm)", "x_precision", "nm");
  check("Position X [nm]", "position_x", "nm");
  check("x_nm", "x", "nm");
  check("YPrecision_nm_", "yprecision", "nm");
  check("locprecnm ", "locprecnm", "");
  check("Position-0-0", "position_0_0", "");
  check("x [\xC2\xB5m]", "x", "\xC2\xB5m");
  check("", "", "");
  check("[nm]", "[nm]", "");
}

TEST(Column, VendorNamesAreKnown) {
  const auto quantity = [](const char* cell) {
    const auto match = match_heading(parse_heading(cell));
    return match ? match->quantity : Quantity::other;
  };
  EXPECT_EQ(quantity("xnm"), Quantity::x);
  EXPECT_EQ(quantity("Position Y [nm]"), Quantity::y);
  EXPECT_EQ(quantity("\xCF\x83z"), Quantity::sigma_z);
  EXPECT_EQ(quantity("locprecznm"), Quantity::sigma_z);
  EXPECT_EQ(quantity("uncertainty [nm]"), Quantity::sigma_lateral);
  EXPECT_EQ(quantity("sitenumbers"), Quantity::particle);
  EXPECT_EQ(quantity("sx"), Quantity::other) << "the width of a PSF is no uncertainty";
  EXPECT_EQ(quantity("PSFxnm"), Quantity::other);
  EXPECT_TRUE(match_heading(parse_heading("sigma"))->weak);
  EXPECT_EQ(match_heading(parse_heading("xnm"))->unit, "nm");
}

TEST(Units, SpellingsOfOneUnitAgree) {
  for (const char* text : {"um", "\xC2\xB5m", "\xCE\xBCm", "\xB5m", "micron", "Micrometer"}) {
    EXPECT_EQ(units::parse_length(text), units::Length::micrometre) << text;
  }
  EXPECT_EQ(units::parse_length("nanometer"), units::Length::nanometre);
  EXPECT_EQ(units::parse_length("px"), units::Length::pixel);
  EXPECT_EQ(units::parse_length("ADU"), std::nullopt);
  EXPECT_EQ(units::to_nm(units::Length::pixel, 130), 130);
  EXPECT_EQ(units::to_nm(units::Length::metre, 0), 1e9);
}

}  // namespace
}  // namespace smlm
