#include "concatenate.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>

#include "smlm/error.hpp"

namespace smlm {
namespace {

std::string without_extension(const std::filesystem::path& file) {
  std::filesystem::path name = file.filename();
  if (name.extension() == ".gz") name = name.stem();
  return name.stem().string();
}

template <class T>
void append_moved(std::vector<T>& all, std::vector<T>& part) {
  if (all.empty()) {
    all = std::move(part);
  } else {
    all.insert(all.end(), part.begin(), part.end());
    std::vector<T>().swap(part);
  }
}

bool constant_z(const LocalisationTable& table) {
  return std::all_of(table.position_nm.begin(), table.position_nm.end(),
                     [&](const auto& p) { return p[2] == table.position_nm.front()[2]; });
}

}  // namespace

std::vector<std::string> short_names(const std::vector<std::string>& files) {
  std::vector<std::string> names;
  std::vector<std::filesystem::path> folders;
  for (const std::string& file : files) {
    names.push_back(without_extension(file));
    folders.push_back(std::filesystem::path(file).parent_path());
  }
  for (int levels = 0; levels < 64; ++levels) {
    std::map<std::string, int> count;
    for (const std::string& name : names) ++count[name];
    bool unique = true;
    for (std::size_t i = 0; i < names.size(); ++i) {
      if (count[names[i]] < 2 || folders[i].empty() || folders[i] == folders[i].parent_path()) continue;
      unique = false;
      names[i] = folders[i].filename().string() + "/" + names[i];
      folders[i] = folders[i].parent_path();
    }
    if (unique) break;
  }
  return names;
}

Concatenation::Concatenation(const std::vector<std::string>& files, const ReadOptions& options)
    : files_(files),
      one_per_file_(options.particles == "one_per_file"),
      file_is_channel_(options.channel.per_file),
      names_(short_names(files)) {
  // The same path twice would give two particles one name.
  const std::set<std::string> distinct(files.begin(), files.end());
  if (distinct.size() != files.size()) {
    throw Error(Fault::usage, "input.files", "names a file twice", "name each file once");
  }
}

void Concatenation::name_particles(LocalisationTable& table) const {
  if (one_per_file_) {
    table.particle_names.assign(1, names_[appended_]);
    std::fill(table.particle.begin(), table.particle.end(), 0);
  } else if (files_.size() > 1 && !file_is_channel_) {
    for (std::string& name : table.particle_names) name = names_[appended_] + ":" + name;
  }
}

void Concatenation::add_channel(LocalisationTable& table) const {
  table.extra.push_back({kFileChannel, "", std::vector<double>(table.size(), 0), {names_[appended_]}});
}

// Particles of one name are one only where files are channels of the same particles.
void Concatenation::append_particles(LocalisationTable& table) {
  std::map<std::string, std::int64_t> known;
  if (file_is_channel_)
    for (std::size_t i = 0; i < all_.particle_names.size(); ++i)
      known.emplace(all_.particle_names[i], static_cast<std::int64_t>(i));
  std::vector<std::int64_t> index;
  for (const std::string& name : table.particle_names) {
    const auto found = known.find(name);
    index.push_back(found != known.end() ? found->second
                                         : static_cast<std::int64_t>(all_.particle_names.size()));
    if (found == known.end()) all_.particle_names.push_back(name);
  }
  for (std::int64_t& particle : table.particle)
    if (particle >= 0) particle = index[static_cast<std::size_t>(particle)];
  append_moved(all_.particle, table.particle);
}

void Concatenation::append_extra(const LocalisationTable& table, std::size_t rows_before) {
  for (const ExtraColumn& column : table.extra) {
    auto found = std::find_if(all_.extra.begin(), all_.extra.end(), [&](const ExtraColumn& known) {
      return known.name == column.name && known.unit == column.unit &&
             known.labels.empty() == column.labels.empty();
    });
    if (found == all_.extra.end()) {
      all_.extra.push_back({column.name, column.unit, {}, {}});
      found = all_.extra.end() - 1;
    }
    found->values.resize(rows_before, std::nan(""));
    const auto offset = static_cast<double>(found->labels.size());
    found->labels.insert(found->labels.end(), column.labels.begin(), column.labels.end());
    for (const double value : column.values) found->values.push_back(value + offset);
  }
}

void Concatenation::append(LocalisationTable table) {
  name_particles(table);
  if (file_is_channel_) add_channel(table);
  for (const std::string& warning : table.warnings) {
    auto& files = warned_files_[warning];
    if (files.empty()) warning_order_.push_back(warning);
    files.push_back(files_[appended_]);
  }
  if (appended_ > 0 && table.planar != all_.planar) {
    throw Error(Fault::input, files_[appended_],
                std::string("has ") + (table.planar ? "no z" : "a z") + " while '" + files_.front() +
                    "' has " + (table.planar ? "one" : "none"),
                "register them apart");
  }
  const std::size_t rows_before = all_.size();
  const auto file = static_cast<std::uint32_t>(appended_);
  if (appended_ == 0) {
    table.warnings.clear();
    all_ = std::move(table);
  } else {
    std::fill(table.source_file.begin(), table.source_file.end(), file);
    append_extra(table, rows_before);
    append_moved(all_.position_nm, table.position_nm);
    append_moved(all_.covariance_nm2, table.covariance_nm2);
    append_particles(table);
    append_moved(all_.source_file, table.source_file);
    append_moved(all_.source_row, table.source_row);
    append_moved(all_.files, table.files);
    append_moved(all_.formats, table.formats);
    for (Rejection& rejection : table.rejected) {
      rejection.file = file;
      all_.rejected.push_back(std::move(rejection));
    }
    for (std::string& line : table.mapping) {
      if (std::find(all_.mapping.begin(), all_.mapping.end(), line) == all_.mapping.end())
        all_.mapping.push_back(line);
    }
    all_.axial_sigma_assumed = all_.axial_sigma_assumed || table.axial_sigma_assumed;
    all_.sigma_assumed = all_.sigma_assumed || table.sigma_assumed;
  }
  for (ExtraColumn& column : all_.extra) column.values.resize(all_.size(), std::nan(""));
  ++appended_;
}

LocalisationTable Concatenation::finish() {
  for (const std::string& warning : warning_order_) {
    const auto& files = warned_files_[warning];
    const std::string more =
        files.size() > 1 ? " and " + std::to_string(files.size() - 1) + " more files" : "";
    all_.warnings.push_back(files.front() + more + ": " + warning);
  }
  if (!all_.planar && all_.size() > 0 && constant_z(all_)) {
    all_.planar = true;
    all_.axial_sigma_assumed = false;
    for (auto& position : all_.position_nm) position[2] = 0;
    all_.warnings.push_back("z is the same everywhere: the table is registered in the plane");
  }
  const auto unassigned = std::count(all_.particle.begin(), all_.particle.end(), -1);
  if (unassigned > 0 && !all_.particle_names.empty()) {
    all_.warnings.push_back(std::to_string(unassigned) + " localisations belong to no particle");
  }
  return std::move(all_);
}

}  // namespace smlm
