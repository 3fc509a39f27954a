#include "smlm/repetitions.hpp"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <memory>
#include <unordered_map>

#include "smlm/error.hpp"

namespace smlm {
namespace {

// Localisations of a particle that stand for it: those with the smallest hashes, so that a copy has the same.
constexpr std::size_t sample_size = 16;

// SplitMix64's finaliser: every bit of the input moves every bit of the output.
std::uint64_t mix(std::uint64_t hash, std::uint64_t value) {
  std::uint64_t z = hash + value + 0x9e3779b97f4a7c15;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9;
  z = (z ^ (z >> 27)) * 0x94d049bb133111eb;
  return z ^ (z >> 31);
}

template <class T>
std::uint64_t mix_bits(std::uint64_t hash, const T& value) {
  static_assert(sizeof(T) % 8 == 0);
  std::array<std::uint64_t, sizeof(T) / 8> words{};
  std::memcpy(words.data(), &value, sizeof(T));
  for (const std::uint64_t word : words) hash = mix(hash, word);
  return hash;
}

std::uint64_t localisation_hash(const LocalisationTable& table, std::size_t row) {
  return mix_bits(mix_bits(0, table.position_nm[row]), table.covariance_nm2[row]);
}

std::uint64_t row_hash(const LocalisationTable& table, std::size_t row) {
  std::uint64_t hash = localisation_hash(table, row);
  for (const ExtraColumn& column : table.extra) {
    const double value = column.values[row];
    // Words are numbered per file: equal words have equal characters.
    hash = column.labels.empty() || value != value
               ? mix_bits(hash, value)
               : mix(hash, std::hash<std::string>()(column.labels[static_cast<std::size_t>(value)]));
  }
  return hash;
}

// The rows of each particle, one after the other.
struct Grouped {
  std::vector<std::uint64_t> first;  // where each particle's begin, and the end of the last
  std::vector<std::uint32_t> row;
};

Grouped group(const LocalisationTable& table) {
  Grouped grouped;
  grouped.first.assign(table.particle_names.size() + 1, 0);
  for (const std::int64_t p : table.particle) grouped.first[static_cast<std::size_t>(p + 1)] += p >= 0 ? 1 : 0;
  for (std::size_t p = 1; p < grouped.first.size(); ++p) grouped.first[p] += grouped.first[p - 1];
  grouped.row.resize(grouped.first.back());
  std::vector<std::uint64_t> next(grouped.first.begin(), grouped.first.end() - 1);
  for (std::size_t row = 0; row < table.size(); ++row) {
    if (table.particle[row] < 0) continue;
    grouped.row[next[static_cast<std::size_t>(table.particle[row])]++] = static_cast<std::uint32_t>(row);
  }
  return grouped;
}

class ParticleMatcher {
 public:
  /// The earlier particle that has half of this one's sample, or none (its own number).
  std::uint32_t original(std::uint32_t particle, const std::vector<std::uint64_t>& sample) {
    std::unordered_map<std::uint32_t, std::size_t> shared;
    for (const std::uint64_t hash : sample) {
      const auto [found, fresh] = owner_.emplace(hash, particle);
      if (!fresh && found->second != particle) ++shared[found->second];
    }
    std::uint32_t best = particle;
    for (const auto& [other, count] : shared) {
      if (2 * count >= sample.size() && other < best) best = other;
    }
    return best;
  }

 private:
  std::unordered_map<std::uint64_t, std::uint32_t> owner_;
};

}  // namespace

Repetitions find_repetitions(const LocalisationTable& table) {
  Repetitions found;
  const Grouped grouped = group(table);
  ParticleMatcher matcher;
  std::vector<std::uint64_t> rows, sample;
  for (std::uint32_t p = 0; p < table.particle_names.size(); ++p) {
    rows.clear();
    sample.clear();
    for (std::uint64_t i = grouped.first[p]; i < grouped.first[p + 1]; ++i) {
      rows.push_back(row_hash(table, grouped.row[i]));
      sample.push_back(localisation_hash(table, grouped.row[i]));
    }
    std::sort(rows.begin(), rows.end());
    const auto distinct = std::unique(rows.begin(), rows.end());
    if (distinct != rows.end() && found.rows == 0) found.example_row = table.particle_names[p];
    found.rows += static_cast<std::uint64_t>(rows.end() - distinct);
    std::sort(sample.begin(), sample.end());
    sample.erase(std::unique(sample.begin(), sample.end()), sample.end());
    sample.resize(std::min(sample.size(), sample_size));
    const std::uint32_t original = matcher.original(p, sample);
    found.original.push_back(original == p ? p : found.original[original]);
    if (original == p) continue;
    if (found.particles++ == 0)
      found.example_particle =
          "'" + table.particle_names[p] + "' is '" + table.particle_names[original] + "' again";
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
    lines.push_back(std::to_string(repetitions.particles) + " particles hold the localisations of an earlier one (" +
                    repetitions.example_particle + "): they count twice, and are kept in one half where halves "
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
    std::memset(block.data() + read, 0, static_cast<std::size_t>(-read) % 8);
    for (int i = 0; i < read; i += 8) {
      std::uint64_t word = 0;
      std::memcpy(&word, block.data() + i, sizeof word);
      hash = mix(hash, word);
    }
    size += static_cast<std::uint64_t>(read);
  }
  return mix(hash, size);
}

}  // namespace smlm
