#include "smlm/repetitions.hpp"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <functional>
#include <map>
#include <memory>
#include <numeric>
#include <utility>

#include "smlm/error.hpp"

namespace smlm {
namespace {

// Localisations of a particle that stand for it: those with the smallest hashes, so that a copy has the same.
constexpr std::size_t sample_size = 8;

// SplitMix64's finaliser: every bit of the input moves every bit of the output.
std::uint64_t mixed(std::uint64_t z) {
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9;
  z = (z ^ (z >> 27)) * 0x94d049bb133111eb;
  return z ^ (z >> 31);
}

// A factor for the i-th word of what is hashed: sums of products do not wait for each other as chains do.
constexpr std::uint64_t golden = 0x9e3779b97f4a7c15;
std::uint64_t factor(std::size_t i) { return mixed(golden * (i + 1)) | 1U; }

std::uint64_t bits_of(double value) {
  std::uint64_t bits = 0;
  std::memcpy(&bits, &value, sizeof bits);
  return bits;
}

// Hashes of rows: of position and uncertainty, and of all columns.
class RowHash {
 public:
  explicit RowHash(const LocalisationTable& table)
      : table_(table), factors_(first_extra + table.extra.size()) {
    for (std::size_t i = 0; i < factors_.size(); ++i) factors_[i] = factor(i);
    words_.resize(table.extra.size());
    for (std::size_t c = 0; c < table.extra.size(); ++c) {
      // Words are numbered per file: equal words have equal characters.
      for (const std::string& word : table.extra[c].labels)
        words_[c].push_back(std::hash<std::string>()(word));
    }
  }

  std::uint64_t localisation(std::size_t row) const {
    std::array<std::uint64_t, first_extra> w{};
    std::memcpy(w.data(), table_.position_nm[row].data(), sizeof(table_.position_nm[row]));
    std::memcpy(w.data() + 3, table_.covariance_nm2[row].data(), sizeof(Covariance));
    std::uint64_t sum = 0;
    for (std::size_t i = 0; i < first_extra; ++i) sum += w[i] * factors_[i];
    return mixed(sum);
  }

  std::uint64_t all(std::uint64_t localisation, std::size_t row) const {
    std::uint64_t sum = localisation;
    for (std::size_t c = 0; c < table_.extra.size(); ++c) {
      const double value = table_.extra[c].values[row];
      const bool word = !words_[c].empty() && value == value;
      sum += factors_[first_extra + c] * (word ? words_[c][static_cast<std::size_t>(value)] : bits_of(value));
    }
    return mixed(sum);
  }

 private:
  static constexpr std::size_t first_extra = 6;  // words of a position and a covariance
  static_assert(sizeof(Covariance) == 3 * sizeof(std::uint64_t));
  const LocalisationTable& table_;
  std::vector<std::uint64_t> factors_;
  std::vector<std::vector<std::uint64_t>> words_;
};

// The rows of each particle, one after the other.
struct Grouped {
  std::vector<std::uint64_t> first;  // where each particle's begin, and the end of the last
  std::vector<std::uint32_t> row;
};

Grouped group(const LocalisationTable& table) {
  Grouped grouped;
  grouped.first.assign(table.particle_names.size() + 1, 0);
  for (const std::int64_t p : table.particle)
    grouped.first[static_cast<std::size_t>(p + 1)] += p >= 0 ? 1 : 0;
  for (std::size_t p = 1; p < grouped.first.size(); ++p) grouped.first[p] += grouped.first[p - 1];
  grouped.row.resize(grouped.first.back());
  std::vector<std::uint64_t> next(grouped.first.begin(), grouped.first.end() - 1);
  for (std::size_t row = 0; row < table.size(); ++row) {
    if (table.particle[row] < 0) continue;
    grouped.row[next[static_cast<std::size_t>(table.particle[row])]++] = static_cast<std::uint32_t>(row);
  }
  return grouped;
}

// A localisation of a particle's sample.
struct Sampled {
  std::uint64_t hash;
  std::uint32_t particle;
  bool operator<(const Sampled& other) const {
    return hash != other.hash ? hash < other.hash : particle < other.particle;
  }
};

// For each particle the earliest one that has half of its sample; itself where none has.
std::vector<std::uint32_t> originals(std::vector<Sampled> samples,
                                     const std::vector<std::uint32_t>& sample_sizes) {
  std::vector<std::uint32_t> original(sample_sizes.size());
  std::iota(original.begin(), original.end(), 0U);
  std::sort(samples.begin(), samples.end());
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> shared;  // (later, first): localisations
  for (std::size_t i = 0; i < samples.size();) {
    const Sampled first = samples[i];
    for (++i; i < samples.size() && samples[i].hash == first.hash; ++i)
      if (samples[i].particle != first.particle) ++shared[{samples[i].particle, first.particle}];
  }
  for (const auto& [pair, count] : shared) {  // by the later one: the earlier one's original is known
    const auto [later, first] = pair;
    if (2 * count >= std::min(sample_sizes[later], sample_sizes[first]) && original[later] == later)
      original[later] = original[first];
  }
  return original;
}

}  // namespace

Repetitions find_repetitions(const LocalisationTable& table) {
  Repetitions found;
  const Grouped grouped = group(table);
  const RowHash hash(table);
  std::vector<std::uint64_t> rows, sample;
  std::vector<Sampled> samples;
  std::vector<std::uint32_t> sample_sizes;
  for (std::uint32_t p = 0; p < table.particle_names.size(); ++p) {
    rows.clear();
    sample.clear();
    for (std::uint64_t i = grouped.first[p]; i < grouped.first[p + 1]; ++i) {
      sample.push_back(hash.localisation(grouped.row[i]));
      rows.push_back(hash.all(sample.back(), grouped.row[i]));
    }
    std::sort(rows.begin(), rows.end());
    const auto distinct = std::unique(rows.begin(), rows.end());
    if (distinct != rows.end() && found.rows == 0) found.example_row = table.particle_names[p];
    found.rows += static_cast<std::uint64_t>(rows.end() - distinct);
    // Of a row that stands twice one is enough.
    if (distinct != rows.end()) {
      std::sort(sample.begin(), sample.end());
      sample.erase(std::unique(sample.begin(), sample.end()), sample.end());
    }
    const auto size = static_cast<std::ptrdiff_t>(std::min(sample.size(), sample_size));
    std::partial_sort(sample.begin(), sample.begin() + size, sample.end());
    for (std::ptrdiff_t i = 0; i < size; ++i) samples.push_back({sample[static_cast<std::size_t>(i)], p});
    sample_sizes.push_back(static_cast<std::uint32_t>(size));
  }
  found.original = originals(std::move(samples), sample_sizes);
  for (std::uint32_t p = 0; p < found.original.size(); ++p) {
    if (found.original[p] == p) continue;
    if (found.particles++ == 0)
      found.example_particle =
          "'" + table.particle_names[p] + "' is '" + table.particle_names[found.original[p]] + "' again";
  }
  return found;
}

std::vector<std::string> describe(const Repetitions& repetitions) {
  std::vector<std::string> lines;
  if (repetitions.rows > 0) {
    lines.push_back(std::to_string(repetitions.rows) +
                    " rows equal an earlier row of their particle in every column (first in particle '" +
                    repetitions.example_row + "'): was a table appended to itself? They count twice");
  }
  if (repetitions.particles > 0) {
    lines.push_back(std::to_string(repetitions.particles) +
                    " particles hold the localisations of an earlier one (" + repetitions.example_particle +
                    "): they count twice, and are kept in one half where halves "
                    "are compared");
  }
  return lines;
}

std::uint64_t content_hash(const std::string& path) {
  const std::unique_ptr<gzFile_s, int (*)(gzFile)> file(gzopen(path.c_str(), "rb"), gzclose);
  if (!file) throw Error(Fault::io, path, "cannot be opened", "check its permissions");
  std::vector<char> block(1 << 20);
  std::uint64_t hash = 0, size = 0;
  while (true) {
    const int read = gzread(file.get(), block.data(), static_cast<unsigned>(block.size()));
    if (read <= 0) break;  // a damaged stream is the reader's to report
    for (int i = 0; i < read; i += static_cast<int>(sizeof(std::uint64_t))) {
      std::uint64_t word = 0;
      std::memcpy(&word, block.data() + i, std::min(sizeof word, static_cast<std::size_t>(read - i)));
      hash = mixed(hash + golden + word);
    }
    size += static_cast<std::uint64_t>(read);
  }
  return mixed(hash + golden + size);
}

}  // namespace smlm
