#include "concatenate.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>

#include "name_index.hpp"
#include "smlm/column.hpp"
#include "smlm/error.hpp"
#include "smlm/number_text.hpp"

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

// Numbers as the words that stand for them.
void as_words(std::vector<double>& values, std::vector<std::string>& labels) {
  if (!labels.empty()) return;
  NameIndex words;
  for (double& value : values) {
    if (!std::isnan(value)) value = static_cast<double>(words.of_text(number_text(value)));
  }
  labels = words.take();
}

bool constant_z(const LocalisationTable& table) {
  return std::all_of(table.position_nm.begin(), table.position_nm.end(),
                     [&](const auto& p) { return p[2] == table.position_nm.front()[2]; });
}

// What a kept column is called where it is compared with those of other files: by its quantity, where it has
// one, else by its name without case and blanks, and its unit.
std::string kind_of(const ExtraColumn& column) {
  const Heading heading = parse_heading(column.name);
  const auto match = match_heading(heading);
  const bool known = match && (match->quantity == Quantity::frame || match->quantity == Quantity::photons ||
                               match->quantity == Quantity::background);
  if (known) return "?" + std::string(column_spec(match->quantity).name);
  return heading.name + "?" + (column.unit.empty() ? heading.unit : column.unit);
}

}  // namespace

std::vector<std::string> short_names(const std::vector<std::string>& files) {
  std::vector<std::string> names;
  std::vector<std::filesystem::path> folders;
  std::map<std::string, int> in_one_folder;
  for (const std::string& file : files) {
    const std::filesystem::path path = std::filesystem::path(file).lexically_normal();
    folders.push_back(path.parent_path());
    names.push_back(without_extension(path));
    ++in_one_folder[(folders.back() / names.back()).string()];
  }
  for (std::size_t i = 0; i < files.size(); ++i) {
    if (in_one_folder[(folders[i] / names[i]).string()] > 1)
      names[i] = std::filesystem::path(files[i]).filename().string();
  }
  while (true) {
    std::map<std::string, int> count;
    for (const std::string& name : names) ++count[name];
    bool longer = false;
    for (std::size_t i = 0; i < names.size(); ++i) {
      const std::string above = folders[i].filename().string();
      if (count[names[i]] < 2 || above.empty()) continue;
      longer = true;
      names[i] = above + "/" + names[i];
      folders[i] = folders[i].parent_path();
    }
    if (!longer) return names;
  }
}

Concatenation::Concatenation(const std::vector<std::string>& files, const ReadOptions& options)
    : files_(files),
      one_per_file_(options.particles == "one_per_file"),
      by_column_(options.particles == "column"),
      file_is_channel_(options.channel.per_file),
      names_(short_names(files)) {
  // The same path twice would give two particles one name.
  const std::set<std::string> distinct(files.begin(), files.end());
  if (distinct.size() != files.size()) {
    throw Error(Fault::usage, "input.files", "names a file twice", "name each file once");
  }
}

void Concatenation::name_particles(LocalisationTable& table) {
  const bool has_column = !table.particle_names.empty() || !table.unassigned.empty();
  if (one_per_file_) {
    if (has_column) with_ignored_particle_column_.push_back(files_[appended_]);
    table.particle_names.assign(1, names_[appended_]);
    table.unassigned.clear();
    std::fill(table.particle.begin(), table.particle.end(), 0);
    return;
  }
  if (by_column_ && !has_column && table.size() > 0) without_particle_column_.push_back(files_[appended_]);
  if (files_.size() < 2 || file_is_channel_) return;
  for (std::string& name : table.particle_names) name = names_[appended_] + ":" + name;
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
  std::set<std::size_t> taken;  // two columns of one file stay two
  for (const ExtraColumn& column : table.extra) {
    const std::string kind = kind_of(column);
    std::size_t at = 0;
    while (at < all_.extra.size() && (taken.count(at) > 0 || kind_of(all_.extra[at]) != kind)) ++at;
    if (at == all_.extra.size()) all_.extra.push_back({column.name, column.unit, {}, {}});
    taken.insert(at);
    ExtraColumn& found = all_.extra[at];
    const bool fresh = found.values.empty();
    found.values.resize(rows_before, std::nan(""));
    std::vector<double> values = column.values;
    std::vector<std::string> labels = column.labels;
    if (!fresh && found.labels.empty() != labels.empty()) {  // numbers in one file, words in another
      as_words(found.values, found.labels);
      as_words(values, labels);
    }
    const auto offset = static_cast<double>(found.labels.size());
    found.labels.insert(found.labels.end(), labels.begin(), labels.end());
    for (const double value : values) found.values.push_back(value + offset);
  }
}

void Concatenation::require_one_depth(const LocalisationTable& table) {
  if (table.size() == 0) return;
  if (table.maybe_planar) {
    maybe_planar_ = true;
    return;
  }
  std::string& first = table.planar ? first_planar_ : first_spatial_;
  if (first.empty()) first = files_[appended_];
  if (first_planar_.empty() || first_spatial_.empty()) return;
  throw Error(Fault::input, files_[appended_],
              table.planar
                  ? "is flat (has no z, or one that says nothing) while '" + first_spatial_ + "' has a z"
                  : "has a z while '" + first_planar_ + "' is flat (has none, or one that says nothing)",
              "register them apart, or all in the plane with input.planar: true");
}

void Concatenation::append(LocalisationTable table) {
  name_particles(table);
  if (file_is_channel_) add_channel(table);
  for (const std::string& warning : table.warnings) {
    auto& files = warned_files_[warning];
    if (files.empty()) warning_order_.push_back(warning);
    files.push_back(files_[appended_]);
  }
  require_one_depth(table);
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
    for (const auto& [name, rows] : table.unassigned) {
      const auto known =
          std::find_if(all_.unassigned.begin(), all_.unassigned.end(),
                       [&, &wanted = name](const auto& entry) { return entry.first == wanted; });
      if (known == all_.unassigned.end()) {
        all_.unassigned.emplace_back(name, rows);
      } else {
        known->second += rows;
      }
    }
    all_.keys_used.insert(table.keys_used.begin(), table.keys_used.end());
    all_.axial_sigma_assumed = all_.axial_sigma_assumed || table.axial_sigma_assumed;
    all_.sigma_assumed = all_.sigma_assumed || table.sigma_assumed;
    all_.planar = all_.planar && table.planar;
  }
  for (ExtraColumn& column : all_.extra) column.values.resize(all_.size(), std::nan(""));
  ++appended_;
}

void Concatenation::warn_about_particles() {
  const auto some = [](const std::vector<std::string>& files) {
    return files.front() +
           (files.size() > 1 ? " and " + std::to_string(files.size() - 1) + " more files" : "");
  };
  if (!with_ignored_particle_column_.empty()) {
    all_.warnings.push_back(
        some(with_ignored_particle_column_) +
        ": has a column that names particles, which input.particles: one_per_file ignores");
  }
  if (all_.particle_names.empty()) return;
  if (!without_particle_column_.empty()) {
    throw Error(Fault::input, some(without_particle_column_),
                "no column says which localisation belongs to which particle, while other files have one",
                "name it under input.columns.particle, or leave the file out");
  }
  const auto unassigned = std::count(all_.particle.begin(), all_.particle.end(), -1);
  if (unassigned == 0) return;
  constexpr std::size_t most_names = 6;
  std::string names;
  for (std::size_t i = 0; i < std::min(all_.unassigned.size(), most_names); ++i) {
    const auto& [name, rows] = all_.unassigned[i];
    names += (i == 0 ? "" : ", ") + (name.empty() ? "empty" : "'" + name + "'") + " " + std::to_string(rows);
  }
  if (all_.unassigned.size() > most_names) names += ", ...";
  all_.warnings.push_back(std::to_string(unassigned) + " localisations belong to no particle" +
                          (names.empty() ? "" : " (rows by what they say: " + names + ")"));
}

LocalisationTable Concatenation::finish() {
  for (const std::string& warning : warning_order_) {
    const auto& files = warned_files_[warning];
    const std::string more =
        files.size() > 1 ? " and " + std::to_string(files.size() - 1) + " more files" : "";
    all_.warnings.push_back(files.front() + more + ": " + warning);
  }
  if (!first_planar_.empty() || (maybe_planar_ && first_spatial_.empty() && constant_z(all_))) {
    if (first_planar_.empty())
      all_.warnings.emplace_back("z is the same everywhere: the table is registered in the plane");
    all_.planar = true;
    all_.axial_sigma_assumed = false;
    for (auto& position : all_.position_nm) position[2] = 0;
  }
  warn_about_particles();
  return std::move(all_);
}

}  // namespace smlm
