#include "smlm/column.hpp"

#include <gtest/gtest.h>

#include <set>

#include "smlm/number_text.hpp"

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
  EXPECT_EQ(match_heading(parse_heading("sigma"))->claim, Claim::weak);
  EXPECT_EQ(match_heading(parse_heading("xnm"))->unit, "nm");
}

TEST(Column, UncertaintiesAreKnownByTheirWords) {
  const auto match = [](const char* cell) { return match_heading(parse_heading(cell)); };
  for (const char* name : {"error_x", "x_err [nm]", "X_loc_error(nm)", "xprecision", "CRLB X", "std x",
                           "x_uncertainty_um", "localization precision x", "lpx", "sdx"}) {
    ASSERT_TRUE(match(name)) << name;
    EXPECT_EQ(match(name)->quantity, Quantity::sigma_x) << name;
    EXPECT_EQ(match(name)->claim, Claim::plain) << name;
  }
  EXPECT_EQ(match("sigma_x")->claim, Claim::likely);
  EXPECT_EQ(match("var-z-nm2")->quantity, Quantity::sigma_z);
  EXPECT_EQ(match("var-z-nm2")->spread, Spread::variance);
  EXPECT_EQ(match("var-z-nm2")->unit, "nm2");
  EXPECT_EQ(match("axial error [um]")->quantity, Quantity::sigma_z);
  EXPECT_EQ(match("x_nm_err")->unit, "nm");
  for (const char* name :
       {"psf sigma x", "photon error", "sx", "x", "background variance", "sigma uncertainty", "err map"})
    EXPECT_FALSE(match(name) && match(name)->quantity >= Quantity::sigma_x &&
                 match(name)->quantity <= Quantity::sigma_zz)
        << name;
  EXPECT_TRUE(sounds_like_uncertainty("photon_error"));
  EXPECT_FALSE(sounds_like_uncertainty("photons"));
}

TEST(NumberText, WholeNumbersAreWrittenInFull) {
  EXPECT_EQ(number_text(100000), "100000");
  EXPECT_EQ(number_text(-9007199254740992.0), "-9007199254740992");
  EXPECT_EQ(number_text(0.1), "0.1");
  EXPECT_EQ(number_text(1e300), "1e+300");
}

TEST(Units, SpellingsOfOneUnitAgree) {
  for (const char* text : {"um", "\xC2\xB5m", "\xCE\xBCm", "\xB5m", "micron", "Micrometer"}) {
    EXPECT_EQ(units::parse_length(text), units::Length::micrometre) << text;
  }
  EXPECT_EQ(units::parse_length("nanometer"), units::Length::nanometre);
  EXPECT_EQ(units::parse_length("px"), units::Length::pixel);
  for (const char* text : {"A", "angstrom", "Angstroms", "\xC3\x85", "\xC5", "\xE2\x84\xAB"}) {
    EXPECT_EQ(units::parse_length(text), units::Length::angstrom) << text;
  }
  EXPECT_EQ(units::parse_length("a"), std::nullopt);
  EXPECT_EQ(units::parse_length("(Camera pixels)"), units::Length::pixel);
  EXPECT_EQ(units::parse_length("Millimetres"), units::Length::millimetre);
  EXPECT_EQ(units::without_square("nm\xC2\xB2"), "nm");
  EXPECT_EQ(units::without_square("um2"), "um");
  EXPECT_EQ(units::parse_length("ADU"), std::nullopt);
  EXPECT_EQ(units::to_nm(units::Length::pixel, 130), 130);
  EXPECT_EQ(units::to_nm(units::Length::metre, 0), 1e9);
}

}  // namespace
}  // namespace smlm
