// Numbers that no microscope gives: nearly always a wrong unit, a wrong column, or the noise taken for a
// particle.
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <map>

#include "particle_numbers.hpp"
#include "smlm/number_text.hpp"

namespace smlm {
namespace {

// PSF widths are 100-150 nm; precisions that large localise nothing.
constexpr double psf_like_sigma_nm = 80;
// Far below the best that MINFLUX and averaged DNA-PAINT reach.
constexpr double tiny_sigma_nm = 0.05;
constexpr double tiny_particle_nm = 1;
constexpr double huge_particle_nm = 1e4;
// Between z and x, y, or between one file and another: a pixel is 100 nm and more, a micrometre 1000.
constexpr double other_unit = 30;
// A particle that is so much larger than the median one is not of its kind.
constexpr double giant_localisations = 10;
constexpr double giant_radius = 4;
constexpr std::size_t fewest_for_a_giant = 4;

// Three significant digits say enough.
std::string nm(double value) {
  std::array<char, 32> digits{};
  const auto end =
      std::to_chars(digits.data(), digits.data() + digits.size(), value, std::chars_format::general, 3).ptr;
  return std::string(digits.data(), end) + " nm";
}

// The lines of the mapping that say where a quantity comes from, in brackets.
std::string source_of(const LocalisationTable& table, const std::vector<std::string>& quantities) {
  std::string lines;
  for (const std::string& line : table.mapping) {
    for (const std::string& quantity : quantities) {
      if (line.rfind(quantity + " <- ", 0) == 0) lines += (lines.empty() ? " (" : "; ") + line;
    }
  }
  return lines.empty() ? lines : lines + ")";
}

// Of rows spread over the table: so many tell an order of magnitude.
double median_sigma_nm(const LocalisationTable& table, bool axial) {
  constexpr std::size_t enough = 100000;
  return summarise(sigmas_nm(table, axial, table.size() / enough + 1)).median;
}

bool far_apart(double a, double b) { return a > 0 && b > 0 && std::max(a, b) > other_unit * std::min(a, b); }

void judge_uncertainties(const LocalisationTable& table, std::vector<std::string>& warnings) {
  if (table.sigma_assumed) return;
  const double lateral = median_sigma_nm(table, false);
  const std::string from = source_of(table, {"sigma_x", "sigma_xy", "sigma_xx"});
  if (lateral > psf_like_sigma_nm) {
    warnings.push_back("the median lateral uncertainty is " + nm(lateral) +
                       ", as large as the width of a PSF: is it the right column, in the right unit?" + from);
  }
  if (lateral < tiny_sigma_nm) {
    warnings.push_back("the median lateral uncertainty is " + nm(lateral) +
                       ", smaller than any microscope's: is it in the right unit?" + from);
  }
  if (table.planar || table.axial_sigma_assumed) return;
  const double axial = median_sigma_nm(table, true);
  const std::string from_z = source_of(table, {"sigma_z", "sigma_zz"});
  if (axial < tiny_sigma_nm) {
    warnings.push_back("the median axial uncertainty is " + nm(axial) +
                       ", smaller than any microscope's: is it in the right unit?" + from_z);
  } else if (far_apart(axial, lateral)) {
    warnings.push_back("the median uncertainty is " + nm(axial) + " axially and " + nm(lateral) +
                       " laterally: is one of them in another unit?" + from_z);
  }
}

void judge_extents(const LocalisationTable& table, const ParticleNumbers& particles,
                   std::vector<std::string>& warnings) {
  const double radius = summarise(particles.radius_nm).median;
  const double lateral = median_sigma_nm(table, false);
  if (lateral > radius) {
    warnings.push_back("the median lateral uncertainty, " + nm(lateral) +
                       ", is larger than the particles, whose radius is " + nm(radius) +
                       (table.sigma_assumed ? " (it is assumed: see input.assumed_sigma_nm)" : ""));
  }
  if (radius < tiny_particle_nm || radius > huge_particle_nm) {
    warnings.push_back("the particles' median radius is " + nm(radius) +
                       ": are the positions in another unit? (input.unit)" + source_of(table, {"x", "y"}));
  }
  const double wide = summarise(particles.lateral_nm).median, deep = summarise(particles.axial_nm).median;
  if (!table.planar && far_apart(wide, deep)) {
    warnings.push_back("the particles spread over " + nm(deep) + " along z and " + nm(wide) +
                       " along x and y: is z in another unit?" + source_of(table, {"z"}));
  }
}

void judge_files(const LocalisationTable& table, const ParticleNumbers& particles,
                 std::vector<std::string>& warnings) {
  std::map<std::uint32_t, std::vector<double>> radii;
  for (std::size_t i = 0; i < particles.particle.size(); ++i)
    radii[particles.file[i]].push_back(particles.radius_nm[i]);
  double least = HUGE_VAL, most = 0;
  std::uint32_t smallest = 0, largest = 0;
  for (const auto& [file, values] : radii) {
    const double median = summarise(values).median;
    if (median < least) {
      least = median;
      smallest = file;
    }
    if (median > most) {
      most = median;
      largest = file;
    }
  }
  if (least < HUGE_VAL && far_apart(least, most)) {
    warnings.push_back("the particles' median radius is " + nm(least) + " in " + table.files[smallest] +
                       " and " + nm(most) + " in " + table.files[largest] +
                       ": are the files in different units?");
  }
}

void judge_giants(const LocalisationTable& table, const ParticleNumbers& particles,
                  std::vector<std::string>& warnings) {
  if (particles.particle.size() < fewest_for_a_giant) return;
  const double usual = summarise(particles.localisations).median;
  const double radius = summarise(particles.radius_nm).median;
  constexpr std::size_t most_named = 3;
  std::size_t giants = 0;
  std::string names;
  for (std::size_t i = 0; i < particles.particle.size(); ++i) {
    if (particles.localisations[i] <= giant_localisations * usual &&
        !(particles.radius_nm[i] > giant_radius * radius))
      continue;
    if (giants++ >= most_named) continue;
    names += (names.empty() ? "'" : ", '") + table.particle_names[particles.particle[i]] + "' (" +
             number_text(particles.localisations[i]) + " localisations, radius " +
             nm(particles.radius_nm[i]) + ")";
  }
  // Where many are large, none is out of the ordinary.
  if (giants == 0 || 10 * giants > particles.particle.size() + 10) return;
  warnings.push_back("far larger than the other particles (median " + number_text(usual) +
                     " localisations, radius " + nm(radius) + "): " + names +
                     (giants > most_named ? " and " + std::to_string(giants - most_named) + " more" : "") +
                     "; if that is what belongs to no particle, give its id under input.unassigned_particle");
}

}  // namespace

std::vector<std::string> implausibilities(const LocalisationTable& table) {
  std::vector<std::string> warnings;
  if (table.size() == 0) return warnings;
  judge_uncertainties(table, warnings);
  const ParticleNumbers particles = measure_particles(table);
  const double radius = summarise(particles.radius_nm).median;
  if (!std::isfinite(radius)) return warnings;
  judge_extents(table, particles, warnings);
  judge_files(table, particles, warnings);
  judge_giants(table, particles, warnings);
  return warnings;
}

}  // namespace smlm
