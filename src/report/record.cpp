#include "polar/report/record.hpp"

#include <algorithm>
#include <cmath>

#include "polar/core/constants.hpp"
#include "smlm/error.hpp"
#include "smlm/h5/file.hpp"

namespace polar {

namespace {
using smlm::h5::File;

// A record may be of an earlier version, or of a run that did not ask for something: all here are optional.
template <class T>
std::vector<T> numbers(const File& file, const std::string& name) {
  return file.exists(name) ? file.read<T>(name) : std::vector<T>{};
}

std::vector<std::string> texts(const File& file, const std::string& name) {
  return file.exists(name) ? file.read_strings(name) : std::vector<std::string>{};
}

template <class T>
T attribute(const File& file, const std::string& object, const char* name, T otherwise) {
  if (!file.exists(object) || !file.has_attribute(object, name)) return otherwise;
  const std::vector<T> values = file.read_attribute<T>(object, name);
  return values.empty() ? otherwise : values.front();
}

std::string text_attribute(const File& file, const std::string& object, const char* name) {
  if (!file.exists(object) || !file.has_attribute(object, name)) return {};
  return file.read_string_attribute(object, name);
}

std::string first(const std::vector<std::string>& list) {
  return list.empty() ? std::string() : list.front();
}

template <class T>
T at(const std::vector<T>& values, std::size_t i, T otherwise) {
  return i < values.size() ? values[i] : otherwise;
}

[[noreturn]] void damaged(const File& file, const std::string& what) {
  throw smlm::Error(smlm::Fault::input, file.path(), what, "run again");
}

// What is drawn must be lengths: a damaged file may hold any number.
void check_lengths(const File& file, const ResultRecord& r) {
  constexpr double kLongest_nm = 1e9;  // a metre
  const auto length = [](double x) { return std::abs(x) < kLongest_nm; };
  const smlm::LocalisationTable& t = r.superparticle;
  for (std::size_t i = 0; i < t.size(); ++i) {
    const auto& x = t.position_nm[i];
    const bool variances = std::all_of(t.covariance_nm2[i].begin(), t.covariance_nm2[i].end(), [&](float c) {
      return std::abs(double(c)) < kLongest_nm * kLongest_nm;
    });
    if (!length(x[0]) || !length(x[1]) || !length(x[2]) || !variances)
      damaged(file, "/superparticle: a position or covariance that is none");
  }
  for (const double x : r.sites.centre_nm.reshaped())
    if (!length(x)) damaged(file, "/template: a centre that is none");
  for (const double x : {r.render.lateral_factor, r.render.axial_factor, r.render.lateral_extra_nm,
                         r.render.axial_extra_nm, r.sites.width_nm})
    if (!length(x)) damaged(file, "a calibration or width that is none");
}

void read_poses(const File& file, RunRecord& r) {
  const auto name = file.read_strings("/poses/particle"), reason = file.read_strings("/poses/reason");
  const auto accepted = file.read<std::uint8_t>("/poses/accepted");
  const auto total = file.read<std::uint64_t>("/poses/n_localisations"),
             used = file.read<std::uint64_t>("/poses/n_used");
  const auto rotation = file.read<double>("/poses/rotation"),
             translation = file.read<double>("/poses/translation"),
             covariance = file.read<double>("/poses/covariance"),
             likelihood = file.read<double>("/poses/log_likelihood"),
             margin = file.read<double>("/poses/margin");
  const auto outliers = numbers<double>(file, "/poses/outlier_fraction"),
             visibility = numbers<double>(file, "/poses/visibility"),
             share = numbers<double>(file, "/poses/posterior_share");
  const std::size_t n = name.size();
  if (reason.size() != n || accepted.size() != n || total.size() != n || used.size() != n ||
      rotation.size() != 9 * n || translation.size() != 3 * n || covariance.size() != 36 * n ||
      likelihood.size() != n || margin.size() != n)
    damaged(file, "/poses: columns of different lengths");
  for (std::size_t i = 0; i < n; ++i) {
    PoseRow row;
    row.particle = name[i], row.reason = reason[i], row.accepted = accepted[i] != 0;
    row.n_localisations = total[i], row.n_used = used[i];
    ParticleFit fit;
    if (row.accepted) {
      Pose pose;
      double rotation_variance = 0, translation_variance = 0;
      for (int a = 0; a < 3; ++a) {
        for (int b = 0; b < 3; ++b)
          pose.rotation(a, b) = rotation[9 * i + static_cast<std::size_t>(3 * a + b)];
        pose.translation[a] = translation[3 * i + static_cast<std::size_t>(a)];
        rotation_variance += covariance[36 * i + static_cast<std::size_t>(7 * a)];
        translation_variance += covariance[36 * i + static_cast<std::size_t>(7 * (a + 3))];
      }
      if (!pose.rotation.allFinite() || !pose.translation.allFinite())
        damaged(file, "/poses: the accepted particle '" + name[i] + "' has no pose");
      row.template_from_view = pose;
      row.rotation_std_deg = kDegreesPerRadian * std::sqrt(rotation_variance);
      row.translation_std_nm = std::sqrt(translation_variance);
      row.log_likelihood = likelihood[i], row.margin = margin[i];
      fit.outlier_fraction = at(outliers, i, PoseRow::kNone);
      fit.visibility = at(visibility, i, PoseRow::kNone);
      fit.posterior_share = at(share, i, PoseRow::kNone);
    }
    r.poses.push_back(std::move(row));
    r.fit.push_back(fit);
  }
  r.least_posterior_share = attribute(file, "/poses", "least_posterior_share", PoseRow::kNone);
  r.most_rotation_std_deg = attribute(file, "/poses", "most_rotation_std_deg", PoseRow::kNone);
  r.most_outliers = attribute(file, "/poses", "most_outliers", PoseRow::kNone);
}

void read_refused(const File& file, RunRecord& r) {
  const auto column = [&](const char* name) {
    return numbers<double>(file, std::string("/rejected/scores/") + name);
  };
  const auto likelihood = column("log_likelihood"), margin = column("margin"),
             rotation = column("rotation_std_deg"), translation = column("translation_std_nm"),
             share = column("posterior_share"), outliers = column("outlier_fraction"),
             visibility = column("visibility");
  for (const auto* other : {&margin, &rotation, &translation, &share, &outliers, &visibility})
    if (other->size() != likelihood.size()) damaged(file, "/rejected/scores: columns of different lengths");
  for (std::size_t i = 0; i < likelihood.size(); ++i)
    r.refused.push_back(
        {likelihood[i], margin[i], rotation[i], translation[i], {outliers[i], visibility[i], share[i]}});
}

void read_rejected(const File& file, RunRecord& r) {
  const auto position = numbers<double>(file, "/rejected/position");
  r.rejected_particle = numbers<std::int64_t>(file, "/rejected/particle");
  if (position.size() != 3 * r.rejected_particle.size())
    damaged(file, "/rejected: columns of different lengths");
  for (std::size_t i = 0; i < r.rejected_particle.size(); ++i) {
    for (std::size_t a = 0; a < 3; ++a)
      if (!std::isfinite(position[3 * i + a])) damaged(file, "/rejected: a position that is none");
    if (r.rejected_particle[i] < 0 || r.rejected_particle[i] >= static_cast<std::int64_t>(r.poses.size()))
      damaged(file, "/rejected: names a particle that is not there");
    r.rejected_position.push_back({position[3 * i], position[3 * i + 1], position[3 * i + 2]});
  }
}

void read_symmetry(const File& file, RunRecord& r) {
  if (!file.exists("/symmetry")) return;
  SymmetryRecord s;
  s.group = text_attribute(file, "/symmetry", "group");
  s.imposed = attribute<std::uint8_t>(file, "/symmetry", "imposed", 0) != 0;
  s.asked = attribute<std::uint8_t>(file, "/symmetry", "asked", 0) != 0;
  s.gain = attribute(file, "/symmetry", "held_out_gain", PoseRow::kNone);
  s.gain_std = attribute(file, "/symmetry", "held_out_gain_std", PoseRow::kNone);
  const auto rotation = numbers<double>(file, "/symmetry/rotation"),
             centre = numbers<double>(file, "/symmetry/centre_nm"),
             unit = numbers<double>(file, "/symmetry/unit_nm");
  if (rotation.size() != 9 || centre.size() != 3 || unit.size() % 3 != 0)
    damaged(file, "/symmetry: not a rotation, a centre and units");
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b < 3; ++b) s.rotation(a, b) = rotation[static_cast<std::size_t>(3 * a + b)];
  s.centre_nm = Eigen::Map<const Eigen::Vector3d>(centre.data());
  s.unit_nm = Eigen::Map<const Eigen::Matrix3Xd>(unit.data(), 3, static_cast<Eigen::Index>(unit.size() / 3));
  s.tried_group = texts(file, "/symmetry/tried/group");
  s.tried_gain = numbers<double>(file, "/symmetry/tried/held_out_gain");
  s.tried_gain_std = numbers<double>(file, "/symmetry/tried/held_out_gain_std");
  s.tried_gain.resize(s.tried_group.size(), PoseRow::kNone);
  s.tried_gain_std.resize(s.tried_group.size(), PoseRow::kNone);
  r.symmetry = std::move(s);
}

void read_labelling(const File& file, RunRecord& r) {
  const std::string group = "/labelling";
  if (!file.exists(group)) return;
  LabellingRecord l;
  l.of = text_attribute(file, group, "of");
  l.efficiency = attribute(file, group, "efficiency", PoseRow::kNone);
  l.low = attribute(file, group, "low", PoseRow::kNone);
  l.high = attribute(file, group, "high", PoseRow::kNone);
  l.labels_per_site = attribute<std::int32_t>(file, group, "labels_per_site", 1);
  l.occupancy = numbers<double>(file, group + "/occupancy");
  l.particles_with = numbers<double>(file, group + "/particles_with");
  l.labels_of = numbers<double>(file, group + "/labels_of");
  if (l.occupancy.empty() || l.particles_with.size() != l.occupancy.size() + 1)
    damaged(file, group + ": columns of different lengths");
  r.labelling = std::move(l);
}

Projections read_projections(const File& file, const std::string& name) {
  Projections p;
  if (!file.exists(name)) return p;
  const smlm::h5::Shape shape = file.info(name).shape;
  p.value = file.read<float>(name);
  if (shape.size() != 3 || shape[0] == 0 || shape[1] != shape[2] || p.value.empty())
    damaged(file, name + ": not square planes");
  p.edge = static_cast<std::size_t>(shape[1]);
  return p;
}

HalfMaps read_half_maps(const File& file, const std::string& group) {
  HalfMaps h;
  h.resolution.period_nm = attribute(file, group, "resolution_nm", PoseRow::kNone);
  h.resolution.at_nyquist = attribute<std::uint8_t>(file, group, "at_nyquist", 0) != 0;
  h.voxel_nm = attribute(file, group, "voxel_nm", 0.0);
  h.refused = attribute<std::uint8_t>(file, group, "refused", 0) != 0;
  h.first_projections = read_projections(file, group + "/first_projections");
  h.second_projections = read_projections(file, group + "/second_projections");
  if (h.first_projections.value.size() != h.second_projections.value.size())
    damaged(file, group + ": half maps of different sizes");
  const auto particles = file.has_attribute(group, "particles")
                             ? file.read_attribute<std::uint64_t>(group, "particles")
                             : std::vector<std::uint64_t>{};
  h.first_particles = at<std::uint64_t>(particles, 0, 0);
  h.second_particles = at<std::uint64_t>(particles, 1, 0);
  h.shells.frequency_per_nm = numbers<double>(file, group + "/frequency_per_nm");
  h.shells.correlation = numbers<double>(file, group + "/correlation");
  h.shells.coefficients = numbers<std::uint64_t>(file, group + "/coefficients");
  if (h.shells.frequency_per_nm.size() != h.shells.correlation.size())
    damaged(file, group + ": columns of different lengths");
  return h;
}

void read_resolution(const File& file, RunRecord& r) {
  if (!file.exists("/resolution/halves")) return;
  ResolutionReport report;
  report.data = read_half_maps(file, "/resolution/halves");
  if (file.exists("/resolution/noise")) report.noise = read_half_maps(file, "/resolution/noise");
  r.resolution = std::move(report);
  r.curve_particles = numbers<double>(file, "/resolution/curve/particles");
  r.curve_resolution_nm = numbers<double>(file, "/resolution/curve/resolution_nm");
  if (r.curve_particles.size() != r.curve_resolution_nm.size())
    damaged(file, "/resolution/curve: columns of different lengths");
}

void read_search(const File& file, RunRecord& r) {
  const std::string starts = "/run/starts/";
  const auto name = texts(file, starts + "name");
  const auto held = numbers<double>(file, starts + "held_out_log_likelihood"),
             held_std = numbers<double>(file, starts + "gain_std");
  const auto won = numbers<std::uint8_t>(file, starts + "won");
  for (std::size_t i = 0; i < name.size(); ++i)
    r.starts.push_back({name[i], at(held, i, PoseRow::kNone), at(held_std, i, PoseRow::kNone),
                        at<std::uint8_t>(won, i, 0) != 0});
  r.agreement = attribute(file, "/run/starts", "agreement", 0.0);
  const std::string rounds = "/run/history/";
  const auto width = numbers<double>(file, rounds + "width_nm"),
             moved = numbers<double>(file, rounds + "moved"),
             escaped = numbers<double>(file, rounds + "escaped"),
             judged = numbers<double>(file, rounds + "held_out_log_likelihood");
  for (std::size_t i = 0; i < judged.size(); ++i)
    r.history.push_back({at(width, i, PoseRow::kNone), at(moved, i, PoseRow::kNone),
                         at(escaped, i, PoseRow::kNone), judged[i]});
  r.stage = texts(file, "/run/timings/stage");
  r.stage_seconds = numbers<double>(file, "/run/timings/seconds");
  if (r.stage.size() != r.stage_seconds.size()) damaged(file, "/run/timings: columns of different lengths");
  r.rounds = attribute<std::int32_t>(file, "/run", "rounds", 0);
  r.converged = attribute<std::uint8_t>(file, "/run", "converged", 0) != 0;
  r.stopped_because = first(texts(file, "/run/stopped_because"));
  r.warnings = texts(file, "/run/warnings");
}

void read_provenance(const File& file, RunRecord& r) {
  r.seed = attribute<std::uint64_t>(file, "/run", "seed", 0);
  r.libraries = texts(file, "/run/libraries");
  r.verdict = text_attribute(file, "/run", "verdict");
  r.verdict_sentence = first(texts(file, "/run/verdict_sentence"));
  r.weights_sha256 = text_attribute(file, "/run", "weights_sha256");
  r.channel_column = text_attribute(file, "/superparticle", "channel_column");
  r.command = first(texts(file, "/run/command"));
  r.machine = first(texts(file, "/run/machine"));
  r.input_file = texts(file, "/run/input_file");
  r.input_sha256 = texts(file, "/run/input_sha256");
  r.input_sha256.resize(r.input_file.size());
  r.rejected_rows_reason = texts(file, "/input/rejected_reason");
  r.rejected_rows = numbers<std::uint64_t>(file, "/input/rejected_rows");
  r.rejected_rows.resize(r.rejected_rows_reason.size());
}
}  // namespace

RunRecord read_run_record(const std::string& path) {
  RunRecord r;
  r.result = read_result_file(path);
  smlm::h5::Limits limits;
  limits.variable_text = false;  // never written here
  const File file = File::open(path, limits);
  check_lengths(file, r.result);
  read_poses(file, r);
  read_rejected(file, r);
  read_refused(file, r);
  read_labelling(file, r);
  read_symmetry(file, r);
  read_resolution(file, r);
  read_search(file, r);
  read_provenance(file, r);
  return r;
}

std::size_t accepted_particles(const RunRecord& record) {
  return static_cast<std::size_t>(
      std::count_if(record.poses.begin(), record.poses.end(), [](const PoseRow& p) { return p.accepted; }));
}

}  // namespace polar
