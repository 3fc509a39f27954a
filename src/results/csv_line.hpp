// One line of comma-separated text (RFC 4180): fields in double quotes may hold commas and doubled quotes.
#pragma once

#include <string>
#include <vector>

namespace polar::results {

std::vector<std::string> split_csv(const std::string& line, char delimiter = ',');

/// The field as it must be written: quoted only where it needs to be; line breaks become spaces.
std::string csv_field(const std::string& text);

/// smlm::number_text(); empty for NaN.
std::string csv_number(double value);

/// A length in nm with four decimals (0.1 pm: far below any localisation's uncertainty), in any locale.
std::string csv_length(double value_nm);

}  // namespace polar::results
