#include "smlm/particle_set.hpp"

#include <algorithm>
#include <limits>

#include "smlm/error.hpp"

namespace smlm {
namespace {

// "12 rows left out because position is not finite; 3 rows ..."
std::string losses(const LocalisationTable& table) {
  std::string text;
  for (const Rejection& r : table.rejected) {
    text += (text.empty() ? "" : "; ") + std::to_string(r.rows) + " rows left out: " + r.reason +
            " (first: row " + std::to_string(r.first_row) +
            (table.files.size() > 1 ? " of " + table.files[r.file] : "") + ")";
  }
  for (const auto& [name, rows] : table.unassigned) {
    text += (text.empty() ? "" : "; ") + std::to_string(rows) + " rows of no particle (" +
            (name.empty() ? "empty" : "'" + name + "'") + ")";
  }
  return text;
}

}  // namespace

std::optional<Error> obstacle_to_registration(const LocalisationTable& table) {
  const std::string file = table.files.empty() ? "input.files" : table.files.front();
  const std::string lost = losses(table);
  const auto obstacle = [&](const std::string& what, const std::string& remedy) {
    return Error(Fault::input, file, what + (lost.empty() ? "" : ": " + lost), remedy);
  };
  if (table.size() == 0)
    return obstacle("no localisation is left", "correct the table, or widen input.filters");
  if (table.particle_names.empty() && table.picked) {
    return obstacle("no place holds enough localisations to be picked",
                    "do input.pick.radius_nm and input.pick.min_localisations suit the particles?");
  }
  if (table.particle_names.empty() && table.unassigned.empty()) {
    return Error(Fault::input, file, "no column says which localisation belongs to which particle",
                 "name it under input.columns.particle, or use input.particles: one_per_file");
  }
  std::vector<bool> filled(table.particle_names.size(), false);
  for (const std::int64_t particle : table.particle) {
    if (particle >= 0) filled[static_cast<std::size_t>(particle)] = true;
  }
  const auto particles = std::count(filled.begin(), filled.end(), true);
  if (particles >= 2) return std::nullopt;
  return obstacle((particles == 1 ? "1 particle holds localisations" : "no particle holds localisations"),
                  table.picked
                      ? "at least two are needed; does input.pick.radius_nm suit the particles?"
                      : "at least two are needed; which column names the particle "
                        "(input.columns.particle), or is each of several files one (input.particles: "
                        "one_per_file)?");
}

ParticleSet group_particles(LocalisationTable table) {
  if (table.size() > std::numeric_limits<std::uint32_t>::max()) {
    throw Error(Fault::resource, "input.files", "hold more than 2^32 localisations",
                "register them in parts");
  }
  if (table.particle_names.empty()) throw obstacle_to_registration(table).value();
  ParticleSet set;
  std::vector<std::uint32_t> sizes(table.particle_names.size(), 0);
  for (const std::int64_t particle : table.particle) {
    if (particle >= 0) ++sizes[static_cast<std::size_t>(particle)];
  }
  set.particles.resize(sizes.size());
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    set.particles[i].name = table.particle_names[i];
    set.particles[i].rows.reserve(sizes[i]);
  }
  for (std::size_t row = 0; row < table.size(); ++row) {
    if (table.particle[row] < 0) continue;
    set.particles[static_cast<std::size_t>(table.particle[row])].rows.push_back(
        static_cast<std::uint32_t>(row));
  }
  set.table = std::move(table);
  return set;
}

}  // namespace smlm
