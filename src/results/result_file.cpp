#include "polar/results/result_file.hpp"

#include <cmath>

#include "polar/core/constants.hpp"
#include "polar/registration/tilt.hpp"
#include "smlm/atomic_file.hpp"
#include "smlm/error.hpp"
#include "smlm/h5/file.hpp"
#include "smlm/table_reader.hpp"
#include "symmetry_record.hpp"

namespace polar {

namespace {
using smlm::h5::File;
constexpr const char* kFormat = "polar-smlm result";
constexpr std::int32_t kFormatVersion = 1;
constexpr int kGzip = 4;
const smlm::h5::Storage kPacked{kGzip, {}};

template <class T>
void write_with_unit(File& file, const std::string& name, const std::vector<T>& values,
                     const smlm::h5::Shape& shape, const char* unit, const char* meaning) {
  const smlm::h5::Storage storage = values.empty() ? smlm::h5::Storage{} : kPacked;
  file.write(name, values, shape, storage);
  file.write_string_attribute(name, "unit", unit);
  file.write_string_attribute(name, "meaning", meaning);
}

void write_poses(File& file, const Results& r) {
  const std::size_t n = r.particles.particles.size();
  std::vector<std::string> name, reason;
  std::vector<double> rotation, translation, covariance, likelihood, margin, share, outliers, visibility;
  std::vector<std::uint8_t> accepted;
  std::vector<std::uint64_t> total, used;
  for (std::size_t i = 0; i < n; ++i) {
    const RegisteredView& v = r.registration.view[i];
    const double gate = v.accepted ? 1 : PoseRow::kNone;  // NaN: a rejected particle has no pose
    const Pose pose = template_from_table(r, i);
    const Eigen::Matrix<double, 6, 6> c = pose_covariance_nm(r, i);
    name.push_back(r.particles.particles[i].name);
    reason.push_back(v.reason);
    accepted.push_back(v.accepted ? 1 : 0);
    total.push_back(r.particles.particles[i].rows.size());
    used.push_back(static_cast<std::uint64_t>(v.n_used));
    for (int a = 0; a < 3; ++a)
      for (int b = 0; b < 3; ++b) rotation.push_back(gate * pose.rotation(a, b));
    for (int a = 0; a < 3; ++a) translation.push_back(gate * pose.translation[a]);
    for (int a = 0; a < 6; ++a)
      for (int b = 0; b < 6; ++b) covariance.push_back(gate * c(a, b));
    likelihood.push_back(gate * v.log_likelihood);
    margin.push_back(gate * v.margin);
    share.push_back(gate * v.posterior_share);
    outliers.push_back(gate * v.outlier_fraction);
    visibility.push_back(gate * v.visibility);
  }
  file.make_group("/poses");
  file.write_attribute("/poses", "least_posterior_share", r.limits.least_posterior_share);
  file.write_attribute("/poses", "most_rotation_std_deg", r.limits.most_rotation_std_deg);
  file.write_attribute("/poses", "most_outliers", r.limits.most_outliers);
  file.write_string_attribute("/poses", "convention",
                              "x_template = rotation x_table + translation; rejected particles are NaN");
  file.write_strings("/poses/particle", name);
  file.write_strings("/poses/reason", reason);
  write_with_unit(file, "/poses/accepted", accepted, {n}, "1",
                  "1 where the particle is part of the superparticle");
  write_with_unit(file, "/poses/n_localisations", total, {n}, "1", "localisations of the particle");
  write_with_unit(file, "/poses/n_used", used, {n}, "1", "localisations that entered the registration");
  write_with_unit(file, "/poses/rotation", rotation, {n, 3, 3}, "1", "rotation matrix, row-major");
  write_with_unit(file, "/poses/translation", translation, {n, 3}, "nm", "translation");
  write_with_unit(file, "/poses/covariance", covariance, {n, 6, 6}, "rad^2, rad nm, nm^2",
                  "covariance of (rotation, translation), left perturbation in the template frame");
  write_with_unit(file, "/poses/log_likelihood", likelihood, {n}, "nat",
                  "mean log density per localisation, in units of the normalisation scale");
  write_with_unit(file, "/poses/posterior_share", share, {n}, "1",
                  "of the pose's posterior that lies here and not at another pose");
  write_with_unit(file, "/poses/margin", margin, {n}, "nat",
                  "log_likelihood above the second-best pose found");
  write_with_unit(file, "/poses/outlier_fraction", outliers, {n}, "1",
                  "share of localisations that the template does not explain");
  write_with_unit(file, "/poses/visibility", visibility, {n}, "1",
                  "share of the template that the particle shows");
}

void write_template(File& file, const Results& r) {
  const TemplateSites sites = template_sites(r);
  const auto k = static_cast<std::uint64_t>(sites.centre_nm.cols());
  write_with_unit(
      file, "/template/centre",
      std::vector<double>(sites.centre_nm.data(), sites.centre_nm.data() + sites.centre_nm.size()), {k, 3},
      "nm", "centres of the fused mixture, template frame");
  write_with_unit(file, "/template/weight",
                  std::vector<double>(sites.weight.data(), sites.weight.data() + sites.weight.size()), {k},
                  "1", "share of each centre");
  const FusedTemplate& fused = r.registration.fused;
  file.write_attribute("/template", "width_nm", sites.width_nm);
  file.write_attribute("/template", "outlier_fraction", fused.outlier_fraction);
  const double volume = std::pow(r.normalisation.scale_nm, r.planar ? 2 : 3);
  file.write_attribute("/template", r.planar ? "outlier_density_per_nm2" : "outlier_density_per_nm3",
                       fused.outlier_density / volume);
}

// The average that lost by evidence: with the symmetry or without it.
void write_other_template(File& file, const OtherTemplate& other, double scale_nm) {
  const auto k = static_cast<std::size_t>(other.fused.centre.cols());
  std::vector<double> centre;
  for (Eigen::Index c = 0; c < other.fused.centre.cols(); ++c)
    for (Eigen::Index a = 0; a < 3; ++a) centre.push_back(scale_nm * other.fused.centre(a, c));
  write_with_unit(file, "/other_template/centre", centre, {k, 3}, "nm", "centres of the other average");
  const Eigen::VectorXd& weight = other.fused.weight;
  write_with_unit(file, "/other_template/weight",
                  std::vector<double>(weight.data(), weight.data() + weight.size()), {k}, "1",
                  "share of each centre");
  file.write_string_attribute("/other_template", "group", other.group);
  file.write_attribute("/other_template", "width_nm", scale_nm * other.fused.width);
  file.write_attribute("/other_template", "held_out_gain", other.gain);
  file.write_attribute("/other_template", "held_out_gain_std", other.gain_std);
}

// Where the texts of a column of text are kept; its values are indices into them.
std::string labels_of(std::size_t column) { return "/input/column_labels/" + std::to_string(column); }

void write_superparticle(File& file, const Results& r, const smlm::LocalisationTable& t) {
  const std::size_t n = t.size();
  const std::string group = "/superparticle/";
  std::vector<double> position;
  std::vector<float> covariance;
  for (const auto& x : t.position_nm) position.insert(position.end(), x.begin(), x.end());
  for (const auto& c : t.covariance_nm2) covariance.insert(covariance.end(), c.begin(), c.end());
  write_with_unit(file, group + "position", position, {n, 3}, "nm", "x, y, z in the template frame");
  write_with_unit(file, group + "covariance", covariance, {n, 6}, "nm^2",
                  "xx, xy, xz, yy, yz, zz, rotated into the template frame");
  write_with_unit(file, group + "particle", t.particle, {n}, "1", "row of /poses");
  write_with_unit(file, group + "source_file", t.source_file, {n}, "1", "row of /input/file");
  write_with_unit(file, group + "source_row", t.source_row, {n}, "1", "data row in that file, from 1");
  file.write_attribute("/superparticle", "planar", static_cast<std::uint8_t>(r.planar ? 1 : 0));
  if (!r.channel_column.empty())
    file.write_string_attribute("/superparticle", "channel_column", r.channel_column);
  file.write_strings("/superparticle/registering_channels", r.registering_channels);
  file.make_group("/superparticle/columns");
  for (std::size_t c = 0; c < t.extra.size(); ++c) {
    const std::string name =
        group + "columns/" + std::to_string(c);  // a column's name may hold any character
    write_with_unit(file, name, t.extra[c].values, {n}, "see /input/column_unit", "see /input/column_name");
  }
  std::vector<std::string> names, units;
  for (const smlm::ExtraColumn& c : t.extra) {
    names.push_back(c.name);
    units.push_back(c.unit);
    if (!c.labels.empty()) file.write_strings(labels_of(names.size() - 1), c.labels);
  }
  file.write_strings("/input/column_name", names);
  file.write_strings("/input/column_unit", units);
  file.write_strings("/input/file", t.files);
  std::vector<std::string> reasons;
  std::vector<std::uint64_t> rows;
  for (const smlm::Rejection& rejection : r.particles.table.rejected) {
    reasons.push_back(rejection.reason);
    rows.push_back(rejection.rows);
  }
  file.write_strings("/input/rejected_reason", reasons);
  file.write("/input/rejected_rows", rows);
}

// What the poses that were not accepted came to: what a cut-off cuts off.
void write_refused(File& file, const Results& r) {
  std::vector<std::int64_t> row;
  std::vector<double> rotation_std_deg, translation_std_nm, likelihood, margin, share, outliers, visibility;
  for (std::size_t i = 0; i < r.registration.view.size(); ++i) {
    const RegisteredView& v = r.registration.view[i];
    if (v.accepted || v.n_used == 0) continue;
    const Eigen::Matrix<double, 6, 6> c = pose_covariance_nm(r, i);
    row.push_back(static_cast<std::int64_t>(i));
    rotation_std_deg.push_back(kDegreesPerRadian * std::sqrt(c.topLeftCorner<3, 3>().trace()));
    translation_std_nm.push_back(std::sqrt(c.bottomRightCorner<3, 3>().trace()));
    likelihood.push_back(v.log_likelihood), margin.push_back(v.margin);
    share.push_back(v.posterior_share), outliers.push_back(v.outlier_fraction);
    visibility.push_back(v.visibility);
  }
  const std::string group = "/rejected/scores/";
  const std::uint64_t n = row.size();
  write_with_unit(file, group + "row", row, {n}, "1", "row of /poses; the others as in /poses");
  write_with_unit(file, group + "rotation_std_deg", rotation_std_deg, {n}, "deg",
                  "of the pose that was refused");
  write_with_unit(file, group + "translation_std_nm", translation_std_nm, {n}, "nm", "likewise");
  write_with_unit(file, group + "log_likelihood", likelihood, {n}, "nat", "likewise");
  write_with_unit(file, group + "margin", margin, {n}, "nat", "likewise");
  write_with_unit(file, group + "posterior_share", share, {n}, "1", "likewise");
  write_with_unit(file, group + "outlier_fraction", outliers, {n}, "1", "likewise");
  write_with_unit(file, group + "visibility", visibility, {n}, "1", "likewise");
}

// Rejected particles as the table has them: the superparticle holds the others.
void write_rejected(File& file, const Results& r) {
  std::vector<double> position;
  std::vector<std::int64_t> particle;
  for (std::size_t i = 0; i < r.particles.particles.size(); ++i) {
    if (r.registration.view[i].accepted) continue;
    for (const std::uint32_t row : r.particles.particles[i].rows) {
      const auto& x = r.particles.table.position_nm[row];
      position.insert(position.end(), x.begin(), x.end());
      particle.push_back(static_cast<std::int64_t>(i));
    }
  }
  const std::size_t n = particle.size();
  write_with_unit(file, "/rejected/position", position, {n, 3}, "nm",
                  "x, y, z in the table's own coordinates");
  write_with_unit(file, "/rejected/particle", particle, {n}, "1", "row of /poses");
  write_refused(file, r);
}

void write_rounds(File& file, const std::vector<RoundReport>& rounds, double scale_nm) {
  std::vector<double> width_nm, moved, escaped, held_out;
  for (const RoundReport& r : rounds) {
    width_nm.push_back(scale_nm * r.width);
    moved.push_back(r.moved), escaped.push_back(r.escaped);
    held_out.push_back(r.held_out_log_likelihood);
  }
  const std::string group = "/run/history/";
  file.write(group + "width_nm", width_nm);
  file.write(group + "moved", moved);
  file.write(group + "escaped", escaped);
  file.write(group + "held_out_log_likelihood", held_out);
}

void write_run(File& file, const Results& r) {
  const Registration& g = r.registration;
  file.make_group("/run");
  file.write_strings("/run/program", {r.provenance.program});
  file.write_strings("/run/libraries", r.provenance.libraries);
  file.write_strings("/run/configuration", {r.provenance.configuration});
  file.write_strings("/run/input_hash", {r.provenance.input_hash});
  if (!r.provenance.command.empty()) file.write_strings("/run/command", {r.provenance.command});
  if (!r.provenance.machine.empty()) file.write_strings("/run/machine", {r.provenance.machine});
  if (!r.provenance.input_file.empty()) {
    file.write_strings("/run/input_file", r.provenance.input_file);
    file.write_strings("/run/input_sha256", r.provenance.input_sha256);
  }
  if (!g.weights_sha256.empty()) file.write_string_attribute("/run", "weights_sha256", g.weights_sha256);
  file.write_attribute("/run", "seed", r.provenance.seed);
  file.write_attribute("/run", "rounds", static_cast<std::int32_t>(g.rounds));
  file.write_attribute("/run", "converged", static_cast<std::uint8_t>(g.converged ? 1 : 0));
  file.write_attribute("/run", "normalisation_scale_nm", r.normalisation.scale_nm);
  file.write_strings("/run/stopped_because", {g.stopped_because});
  if (!g.verdict_reason.empty()) {
    file.write_string_attribute("/run", "verdict", to_string(g.verdict));
    file.write_strings("/run/verdict_sentence", {g.verdict_reason});
  }
  file.write_attribute("/run", "structure_gain", g.structure_gain);
  file.write_attribute("/run", "structure_gain_std", g.structure_gain_std);
  std::vector<std::string> warnings = r.particles.table.warnings;
  warnings.insert(warnings.end(), g.warnings.begin(), g.warnings.end());
  file.write_strings("/run/warnings", warnings);
  std::vector<std::string> stage, start;
  std::vector<double> seconds, processor_seconds, held_out, gain, gain_std;
  std::vector<std::uint8_t> won;
  for (const auto& t : g.timings) {
    stage.push_back(t.stage);
    seconds.push_back(t.seconds);
    processor_seconds.push_back(t.processor_seconds);
  }
  for (const StartReport& s : g.starts) {
    start.push_back(s.name);
    held_out.push_back(s.held_out_log_likelihood);
    gain.push_back(s.gain), gain_std.push_back(s.gain_std);
    won.push_back(s.won ? 1 : 0);
  }
  file.write_strings("/run/timings/stage", stage);
  file.write("/run/timings/seconds", seconds);
  file.write("/run/timings/processor_seconds", processor_seconds);
  file.write_strings("/run/starts/name", start);
  file.write("/run/starts/held_out_log_likelihood", held_out);
  file.write("/run/starts/gain", gain);
  file.write("/run/starts/gain_std", gain_std);
  file.write("/run/starts/won", won);
  file.write_attribute("/run/starts", "agreement", g.agreement);
  write_rounds(file, g.history, r.normalisation.scale_nm);
  if (const std::optional<TiltSpread> tilt = tilt_spread(g.view); tilt && !r.planar) {
    file.write_attribute("/run", "tilt_std_deg", tilt->std_deg);
    file.write_attribute("/run", "tilt_particles", static_cast<std::uint64_t>(tilt->particles));
  }
  const double scale_nm = r.normalisation.scale_nm;
  file.make_group("/run/calibration");
  file.write_string_attribute("/run/calibration", "meaning",
                              "sigma_effective^2 = factor^2 sigma^2 + extra^2");
  file.write_attribute("/run/calibration", "lateral_factor", g.calibration.lateral_factor);
  file.write_attribute("/run/calibration", "axial_factor", g.calibration.axial_factor);
  file.write_attribute("/run/calibration", "lateral_extra_nm", scale_nm * g.calibration.lateral_extra);
  file.write_attribute("/run/calibration", "axial_extra_nm", scale_nm * g.calibration.axial_extra);
}

void write_labelling(File& file, const LabelledPlaces& l) {
  const std::string group = "/labelling";
  file.make_group(group);
  file.write_string_attribute(group, "of", l.labelling.of);
  file.write_attribute(group, "efficiency", l.labelling.efficiency);
  file.write_attribute(group, "low", l.labelling.low);
  file.write_attribute(group, "high", l.labelling.high);
  file.write_attribute(group, "labels_per_site", static_cast<std::int32_t>(l.labelling.labels_per_site));
  file.write_attribute(group, "particles", static_cast<std::uint64_t>(l.labelling.particles));
  file.write_attribute(group, "fewest_sites", static_cast<std::int32_t>(l.labelling.fewest));
  std::vector<double> place;
  for (Eigen::Index k = 0; k < l.place_nm.cols(); ++k)
    for (Eigen::Index a = 0; a < 3; ++a) place.push_back(l.place_nm(a, k));
  write_with_unit(file, group + "/place", place, {static_cast<std::uint64_t>(l.place_nm.cols()), 3}, "nm",
                  "where labels are counted, template frame");
  const auto write = [&](const char* name, const std::vector<double>& values, const char* meaning) {
    write_with_unit(file, group + "/" + name, values, {values.size()}, "1", meaning);
  };
  write("occupancy", l.counts.occupancy, "share of the accepted particles with a label at each place");
  write("particles_with", l.counts.particles, "[n]: accepted particles with n labelled places, expected");
  write("labels_of", l.counts.labels, "[k]: labelled places with k localisations, expected");
}

void write_projections(File& file, const std::string& name, const Projections& p) {
  if (p.planes() == 0) return;
  write_with_unit(file, name, p.value, {p.planes(), p.edge, p.edge}, "nm^-2",
                  "the half map summed through its depth: planes xy, xz, yz; rows from the bottom");
}

void write_half_maps(File& file, const std::string& group, const HalfMaps& h) {
  file.make_group(group);
  file.write_attribute(group, "resolution_nm", h.resolution.period_nm);  // NaN: nothing is resolved
  file.write_attribute(group, "at_nyquist", static_cast<std::uint8_t>(h.resolution.at_nyquist ? 1 : 0));
  file.write_attribute(group, "voxel_nm", h.voxel_nm);
  file.write_attribute(group, "particles", std::vector<std::uint64_t>{h.first_particles, h.second_particles});
  file.write_attribute(group, "refused", static_cast<std::uint8_t>(h.refused ? 1 : 0));
  write_projections(file, group + "/first_projections", h.first_projections);
  write_projections(file, group + "/second_projections", h.second_projections);
  file.write(group + "/frequency_per_nm", h.shells.frequency_per_nm);
  file.write(group + "/correlation", h.shells.correlation);
  file.write(group + "/coefficients", h.shells.coefficients);
}

void write_resolution(File& file, const ResolutionReport& r) {
  file.make_group("/resolution");
  file.write_attribute("/resolution", "threshold", kResolutionThreshold);
  file.write_attribute("/resolution", "supported", static_cast<std::uint8_t>(r.supported() ? 1 : 0));
  write_half_maps(file, "/resolution/halves", r.data);
  write_half_maps(file, "/resolution/noise", r.noise);
}

template <class T>
T one_number(const File& file, const std::string& object, const char* name) {
  const std::vector<T> values = file.read_attribute<T>(object, name);
  if (values.size() != 1)
    throw smlm::Error(smlm::Fault::input, file.path() + ":" + object,
                      std::string(name) + " is not one number", "run again");
  return values[0];
}

std::vector<PoseRow> read_poses(const File& file, const std::string& path,
                                const std::vector<std::string>& names) {
  const auto rotation = file.read<double>("/poses/rotation"), shift = file.read<double>("/poses/translation"),
             likelihood = file.read<double>("/poses/log_likelihood");
  const auto accepted = file.read<std::uint8_t>("/poses/accepted");
  const std::size_t n = names.size();
  if (rotation.size() != 9 * n || shift.size() != 3 * n || likelihood.size() != n || accepted.size() != n)
    throw smlm::Error(smlm::Fault::input, path + ":/poses", "columns of different lengths", "run again");
  std::vector<PoseRow> rows(n);
  for (std::size_t i = 0; i < n; ++i) {
    rows[i].particle = names[i];
    rows[i].accepted = accepted[i] != 0;
    rows[i].log_likelihood = likelihood[i];
    if (!rows[i].accepted) continue;
    using RowMajor = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
    rows[i].template_from_view =
        Pose{Eigen::Map<const RowMajor>(&rotation[9 * i]), Eigen::Map<const Eigen::Vector3d>(&shift[3 * i])};
  }
  return rows;
}

std::string one_string(const File& file, const char* name) {
  const std::vector<std::string> values = file.read_strings(name);
  return values.empty() ? std::string() : values.front();
}
}  // namespace

void write_result_file(const std::string& path, const Results& results,
                       const smlm::LocalisationTable& superparticle) {
  smlm::AtomicFile atomic(path);
  File file = File::create(atomic);
  file.write_string_attribute("/", "format", kFormat);
  file.write_attribute("/", "format_version", kFormatVersion);
  write_poses(file, results);
  write_template(file, results);
  write_superparticle(file, results, superparticle);
  write_rejected(file, results);
  write_run(file, results);
  if (results.registration.other)
    write_other_template(file, *results.registration.other, results.normalisation.scale_nm);
  if (results.registration.symmetry)
    write_symmetry(file, *results.registration.symmetry, results.normalisation.scale_nm);
  if (results.resolution) write_resolution(file, *results.resolution);
  if (results.labelled) write_labelling(file, *results.labelled);
  file.close();
  atomic.commit();
}

bool is_result_file(const std::string& path) {
  if (!smlm::read_head(path).hdf5) return false;
  const File file = File::open(path);
  return file.has_attribute("/", "format") && file.read_string_attribute("/", "format") == kFormat;
}

ResultRecord read_result_file(const std::string& path) {
  smlm::h5::Limits limits;
  limits.variable_text = false;  // never written here
  const File file = File::open(path, limits);
  if (!file.has_attribute("/", "format") || file.read_string_attribute("/", "format") != kFormat)
    throw smlm::Error(smlm::Fault::input, path, "not a result of polar run", "give a results.h5");
  if (one_number<std::int32_t>(file, "/", "format_version") > kFormatVersion)
    throw smlm::Error(smlm::Fault::input, path, "written by a later version", "update polar");
  ResultRecord record;
  smlm::LocalisationTable& t = record.superparticle;
  const auto position = file.read<double>("/superparticle/position");
  const auto covariance = file.read<float>("/superparticle/covariance");
  t.particle = file.read<std::int64_t>("/superparticle/particle");
  t.source_file = file.read<std::uint32_t>("/superparticle/source_file");
  t.source_row = file.read<std::uint64_t>("/superparticle/source_row");
  const std::size_t n = t.particle.size();
  if (position.size() != 3 * n || covariance.size() != 6 * n || t.source_file.size() != n ||
      t.source_row.size() != n)
    throw smlm::Error(smlm::Fault::input, path + ":/superparticle", "columns of different lengths",
                      "run again");
  for (std::size_t i = 0; i < n; ++i) {
    t.position_nm.push_back({position[3 * i], position[3 * i + 1], position[3 * i + 2]});
    const float* c = &covariance[6 * i];
    t.covariance_nm2.push_back({c[0], c[1], c[2], c[3], c[4], c[5]});
  }
  t.planar = one_number<std::uint8_t>(file, "/superparticle", "planar") != 0;
  t.particle_names = file.read_strings("/poses/particle");
  t.files = file.read_strings("/input/file");
  for (std::size_t i = 0; i < n; ++i)
    if (t.particle[i] < -1 || t.particle[i] >= static_cast<std::int64_t>(t.particle_names.size()) ||
        t.source_file[i] >= t.files.size())
      throw smlm::Error(smlm::Fault::input, path + ":/superparticle",
                        "names a particle or file that is not there", "run again");
  const auto names = file.read_strings("/input/column_name"), units = file.read_strings("/input/column_unit");
  for (std::size_t c = 0; c < names.size() && c < units.size(); ++c) {
    t.extra.emplace_back();
    t.extra.back().name = names[c];
    t.extra.back().unit = units[c];
    t.extra.back().values = file.read<double>("/superparticle/columns/" + std::to_string(c));
    if (file.exists(labels_of(c))) t.extra.back().labels = file.read_strings(labels_of(c));
    for (const double value : t.extra.back().values)
      if (!t.extra.back().labels.empty() && !std::isnan(value) &&
          !(value >= 0 && value < static_cast<double>(t.extra.back().labels.size())))
        throw smlm::Error(smlm::Fault::input, path + ":/superparticle/columns/" + std::to_string(c),
                          "names a text that is not there", "run again");
    if (t.extra.back().values.size() != n)
      throw smlm::Error(smlm::Fault::input, path + ":/superparticle", "columns of different lengths",
                        "run again");
  }
  const auto calibration = [&](const char* name) {
    return one_number<double>(file, "/run/calibration", name);
  };
  record.render.lateral_factor = calibration("lateral_factor");
  record.render.axial_factor = calibration("axial_factor");
  record.render.lateral_extra_nm = calibration("lateral_extra_nm");
  record.render.axial_extra_nm = calibration("axial_extra_nm");
  if (file.has_attribute("/superparticle", "channel_column"))
    record.render.channel_column = file.read_string_attribute("/superparticle", "channel_column");
  if (file.exists("/superparticle/registering_channels"))
    record.registering_channels = file.read_strings("/superparticle/registering_channels");
  record.poses = read_poses(file, path, t.particle_names);
  const auto centre = file.read<double>("/template/centre"), weight = file.read<double>("/template/weight");
  if (centre.size() != 3 * weight.size())
    throw smlm::Error(smlm::Fault::input, path + ":/template", "centres and weights differ in number",
                      "run again");
  const auto k = static_cast<Eigen::Index>(weight.size());
  record.sites.centre_nm = Eigen::Map<const Eigen::Matrix3Xd>(centre.data(), 3, k);
  record.sites.weight = Eigen::Map<const Eigen::VectorXd>(weight.data(), k);
  record.sites.width_nm = one_number<double>(file, "/template", "width_nm");
  record.program = one_string(file, "/run/program");
  record.configuration = one_string(file, "/run/configuration");
  record.input_hash = one_string(file, "/run/input_hash");
  record.warnings = file.read_strings("/run/warnings");
  return record;
}

}  // namespace polar
