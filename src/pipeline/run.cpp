#include "polar/pipeline/run.hpp"

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "checkpoint_store.hpp"
#include "halves.hpp"
#include "held_back.hpp"
#include "initial_poses.hpp"
#include "input_hash.hpp"
#include "json_text.hpp"
#include "labelling_text.hpp"
#include "machine.hpp"
#include "output_directory.hpp"
#include "polar/core/symmetry_group.hpp"
#include "polar/model/shipped_weights.hpp"
#include "polar/pipeline/outputs.hpp"
#include "polar/pipeline/version.hpp"
#include "polar/registration/prepare.hpp"
#include "polar/report/page.hpp"
#include "polar/results/labelling.hpp"
#include "polar/results/mrc.hpp"
#include "polar/results/registering_rows.hpp"
#include "polar/results/result_file.hpp"
#include "polar/results/results.hpp"
#include "polar/results/sites.hpp"
#include "polar/results/strangers.hpp"
#include "polar/results/template_frame.hpp"
#include "polar/results/units.hpp"
#include "run_text.hpp"
#include "smlm/atomic_file.hpp"
#include "smlm/error.hpp"
#include "smlm/table_reader.hpp"
#include "template_file.hpp"

namespace polar {

namespace {
constexpr const char* kSummary = "summary.json";
constexpr double kLeastBackground = 1e-3;  // share of localisations that no template explains

class Stopwatch {
 public:
  double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

// The configuration without where its files lie: the same computation in another place is the same.
std::string computation_text(RunConfig config) {
  OutputOptions computed;  // of the output, only this is a computation
  computed.resolution = config.output.resolution;
  computed.frame = config.output.frame;
  computed.labels_per_site = config.output.labels_per_site;
  config.output = computed;
  const auto name_only = [](std::string& file) { file = std::filesystem::path(file).filename().string(); };
  std::for_each(config.files.begin(), config.files.end(), name_only);
  name_only(config.read.pick.centres);
  name_only(config.registration.weights);
  name_only(config.initial_poses);
  name_only(config.template_file);
  return run_config_text(config);
}

// Everything that is read.
std::vector<std::string> input_files(const RunConfig& config) {
  std::vector<std::string> files = config.files;
  if (!config.read.pick.centres.empty()) files.push_back(config.read.pick.centres);
  if (!config.initial_poses.empty()) files.push_back(config.initial_poses);
  if (!config.template_file.empty()) files.push_back(config.template_file);
  if (needs_weights(config.registration)) files.push_back(weights_path(config.registration.weights));
  return files;
}

// Whether the directory holds a complete result of this very computation.
bool is_complete_of(const std::string& directory, const std::string& hash) {
  std::ifstream in(directory + "/" + kSummary);
  if (!in) return false;
  const nlohmann::json summary = nlohmann::json::parse(in, nullptr, false);
  if (!summary.is_object() || !summary.contains("input_hash")) return false;
  return summary["input_hash"] == hash;
}

// A result of another computation is never mixed with or silently replaced.
void refuse_other_result(const pipeline::OutputDirectory& directory) {
  if (!std::filesystem::exists(directory.file(kSummary))) return;
  throw smlm::Error(smlm::Fault::input, directory.file(kSummary), "belongs to another input or configuration",
                    "give --overwrite to replace it, or choose another output.directory");
}

// Whether an earlier run is gone on with. To replace what is there, one of another computation is dropped.
bool continues(pipeline::CheckpointStore& checkpoint, const RunFlags& flags, Progress& progress) {
  try {
    if (flags.resume) return checkpoint.resume(progress);
  } catch (const smlm::Error&) {
    if (!flags.overwrite) throw;
  }
  checkpoint.remove();
  return false;
}

smlm::ParticleSet read_particles(const RunConfig& config, Progress& progress) {
  smlm::ParticleSet set = smlm::group_particles(smlm::read_tables(config.files, config.read));
  for (const std::string& warning : set.table.warnings) progress.note("warning: " + warning);
  for (const smlm::Rejection& r : set.table.rejected)
    progress.note("warning: " + std::to_string(r.rows) + " rows left out: " + r.reason + " (first: row " +
                  std::to_string(r.first_row) + ")");
  if (const auto obstacle = smlm::obstacle_to_registration(set.table)) throw *obstacle;
  return set;
}

Results compute(const RunConfig& config, const std::string& hash, Progress& progress, Checkpoint& checkpoint,
                const Engine& engine) {
  Results r;
  r.particles = read_particles(config, progress);
  r.channel_column = smlm::channel_column(config.read.channel);
  r.registering_channels = config.read.channel.registering;
  pipeline::HeldBack held_back(r.particles, config.read.channel, config.read.particle_limits, progress);
  Views views = prepare_views(r.particles, {});
  RegistrationOptions options = config.registration;
  if (!config.template_file.empty()) options.known = pipeline::read_template(config.template_file);
  PartOfCheckpoint all(checkpoint, "all");
  r.registration = config.initial_poses.empty()
                       ? engine(views, options, progress, all)
                       : register_from(views,
                                       pipeline::initial_poses(config.initial_poses, r.particles.particles,
                                                               views.normalisation, progress),
                                       options, progress);
  r.normalisation = std::move(views.normalisation);
  r.planar = views.planar;
  r.limits = options.engine.verdict;
  r.provenance = {program_version(), run_config_text(config), config.registration.seed, hash,
                  library_versions()};
  if (config.output.frame == "own" && accepted_particles(r) > 0)
    move_template(r.registration, own_frame_from_template(r.registration, r.planar));
  if (config.output.resolution == "halves" && accepted_particles(r) > 0 && !progress.cancelled())
    r.resolution = pipeline::resolve_halves(r, options, progress, checkpoint, engine);
  if (progress.cancelled()) return r;
  held_back.put_back(r);
  return r;
}

// What a result is written from, made once.
struct Products {
  smlm::LocalisationTable superparticle;
  RenderOptions render;
  DiscreteSites sites;
};

// From the symmetric units where the sites cannot be told apart.
std::optional<LabelledPlaces> unit_labelling(const Results& r, const smlm::LocalisationTable& labels,
                                             int labels_per_unit) {
  const FusedTemplate& fused = r.registration.fused;
  const double scale_nm = r.normalisation.scale_nm;
  const Eigen::Matrix3Xd unit_nm = scale_nm * r.registration.symmetry->unit;
  const UnitOccupancy units = occupied_units(labels, template_sites(r), unit_nm,
                                             fused.outlier_density / std::pow(scale_nm, r.planar ? 2 : 3),
                                             std::max(fused.outlier_fraction, kLeastBackground));
  if (!units.counts.any()) return std::nullopt;
  LabelledPlaces l{labelling_efficiency(units.counts, labels_per_unit), units.counts, unit_nm};
  l.labelling.of = "symmetric units";
  return l;
}

// Of the sites, or of the symmetric units where those cannot be told apart.
std::optional<LabelledPlaces> labelled_places(const Results& r, const DiscreteSites& sites,
                                              const smlm::LocalisationTable& labels, int labels_per_site) {
  if (sites.site.empty())
    return r.registration.symmetry ? unit_labelling(r, labels, labels_per_site) : std::nullopt;
  if (!sites.counts.any()) return std::nullopt;
  Eigen::Matrix3Xd place_nm(3, static_cast<Eigen::Index>(sites.site.size()));
  for (std::size_t k = 0; k < sites.site.size(); ++k)
    place_nm.col(static_cast<Eigen::Index>(k)) = sites.site[k].centre_nm;
  return LabelledPlaces{labelling_efficiency(sites.counts, labels_per_site), sites.counts, place_nm};
}

Products products_of(Results& r, const RunConfig& config) {
  Products p;
  p.superparticle = superparticle(r);
  p.render = calibrated_rendering(r.registration.calibration, r.normalisation.scale_nm);
  p.render.voxel_nm = config.output.voxel_nm;
  p.render.channel_column = r.channel_column;
  // Labels of the channels that are carried along have no place in the template.
  smlm::LocalisationTable registering;
  if (!r.channel_column.empty()) registering = registering_rows(p.superparticle, config.read.channel);
  const smlm::LocalisationTable& labels = r.channel_column.empty() ? p.superparticle : registering;
  p.sites = find_sites(labels, p.render);
  if (const auto& symmetry = r.registration.symmetry;
      symmetry && symmetry->in_use && is_symmetry_group(symmetry->group)) {
    Pose canonical = symmetry->canonical_from_template;
    canonical.translation *= r.normalisation.scale_nm;
    set_orbits(p.sites, symmetry_rotations(symmetry->group), canonical);
  }
  r.labelled = labelled_places(r, p.sites, labels, config.output.labels_per_site);
  return p;
}

// Poses, record and page: also of a run in which no particle has a pose.
std::vector<std::string> write_account(const Results& r, const RunConfig& config,
                                       const pipeline::OutputDirectory& directory,
                                       const smlm::LocalisationTable& aligned) {
  // Without its summary the directory is not complete: it goes first and comes back last.
  std::filesystem::remove(directory.file(kSummary));
  std::vector<std::string> written = {"poses.csv"};
  smlm::write_file_atomically(directory.file("poses.csv"), format_pose_table(pose_rows(r)));
  const std::vector<std::string>& formats = config.output.formats;
  const bool record = std::find(formats.begin(), formats.end(), "hdf5") != formats.end();
  const std::string path = directory.file("results.h5");
  if (record || config.output.report) write_result_file(path, r, aligned);
  if (config.output.report) {
    write_report(path, directory.file(kReportFile), report_name(config.output.directory));
    written.emplace_back(kReportFile);
  }
  if (record)
    written.emplace_back("results.h5");
  else
    std::filesystem::remove(path);  // the page alone was wanted
  return written;
}

std::vector<std::string> write(const Results& r, const Products& p, const RunConfig& config,
                               const pipeline::OutputDirectory& directory, Progress& progress) {
  const ExportInput input{p.superparticle, p.render, pose_rows(r), &p.sites};
  std::vector<std::string> written = write_account(r, config, directory, p.superparticle);
  std::vector<std::string> formats = config.output.formats;
  if (config.output.preview && std::find(formats.begin(), formats.end(), "png") == formats.end())
    formats.emplace_back("png");
  for (const std::string& format : formats) {
    if (format == "hdf5") continue;  // above
    std::vector<std::string> notes;
    for (const std::string& name : write_format(format, config.output.directory, input, notes))
      written.push_back(name);
    for (const std::string& note : notes) progress.note("warning: " + note);
    if (format == "mrc" && r.resolution && !r.resolution->data.first_density.density.empty()) {
      write_mrc(directory.file(half_map_files()[0]), r.resolution->data.first_density);
      write_mrc(directory.file(half_map_files()[1]), r.resolution->data.second_density);
      written.insert(written.end(), half_map_files().begin(), half_map_files().end());
    }
  }
  return written;
}
}  // namespace

Engine default_engine() {
  return [](const Views& views, const RegistrationOptions& options, Progress& p, Checkpoint& checkpoint) {
    return register_views(views, options, p, checkpoint);
  };
}

bool is_complete(const RunConfig& config) {
  std::error_code unseen;
  if (!std::filesystem::exists(config.output.directory + "/" + kSummary, unseen)) return false;
  return is_complete_of(config.output.directory,
                        pipeline::input_hash(input_files(config), computation_text(config)).both);
}

RunOutcome run(const RunConfig& config, const RunFlags& flags, Progress& progress, const Engine& engine) {
  const Stopwatch watch;
  const pipeline::OutputDirectory directory(config.output.directory, flags);
  const pipeline::InputHash hash = pipeline::input_hash(input_files(config), computation_text(config));
  pipeline::CheckpointStore checkpoint(directory, {program_version(), hash.files, hash.configuration});
  if (flags.resume && is_complete_of(config.output.directory, hash.both)) {
    checkpoint.remove();
    return {false, false, {"results      " + config.output.directory + " (complete already)"}};
  }
  if (!continues(checkpoint, flags, progress) && !flags.overwrite) refuse_other_result(directory);
  Results r = compute(config, hash.both, progress, checkpoint, engine);
  r.provenance.command = flags.command;
  r.provenance.machine = pipeline::machine_text();
  r.provenance.input_file = input_files(config);
  r.provenance.input_sha256 = hash.sha256;
  if (progress.cancelled()) return {true, checkpoint.flush(), {}};
  for (const std::string& warning : r.registration.warnings) progress.note("warning: " + warning);
  if (accepted_particles(r) == 0) {
    if (config.output.report) {
      directory.remove_other_results(write_account(r, config, directory, superparticle(r)));
      checkpoint.remove();
      progress.note(directory.file(kReportFile) + " shows the particles");
    }
    const auto reasons = pipeline::rejections(r);
    throw smlm::Error(smlm::Fault::numerical, config.files.front(), "no particle could be registered",
                      reasons.empty() ? "" : "most were rejected because: " + reasons.front().second);
  }
  const Products products = products_of(r, config);
  const std::vector<std::string> written = write(r, products, config, directory, progress);
  const double seconds = watch.seconds();
  const std::vector<Stranger> unlike = strangers(pose_rows(r));
  std::vector<std::string> lines =
      pipeline::describe(r, config.registration.tilt_deg, unlike, config.output.directory, seconds);
  const Labelling* labelling = r.labelled ? &r.labelled->labelling : nullptr;
  const std::vector<std::string> labels = pipeline::labelling_lines(products.sites, labelling);
  lines.insert(lines.end() - 2, labels.begin(), labels.end());
  nlohmann::json summary = pipeline::summary_json(r, unlike, lines, written, seconds);
  pipeline::add_labelling(summary, products.sites, labelling);
  smlm::write_file_atomically(directory.file(kSummary), pipeline::json_text(summary));
  std::vector<std::string> kept = written;
  kept.emplace_back(kSummary);
  directory.remove_other_results(kept);
  checkpoint.remove();
  return {false, false, lines};
}

RunOutcome run(const RunConfig& config, const RunFlags& flags, Progress& progress) {
  return run(config, flags, progress, default_engine());
}

}  // namespace polar
