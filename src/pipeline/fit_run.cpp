#include "polar/pipeline/fit_run.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "drawn_points.hpp"
#include "fit_tables.hpp"
#include "json_text.hpp"
#include "model_file.hpp"
#include "output_directory.hpp"
#include "polar/core/median.hpp"
#include "polar/core/parallel.hpp"
#include "polar/pipeline/version.hpp"
#include "polar/results/preview.hpp"
#include "polar/simulation/structure_file.hpp"
#include "smlm/atomic_file.hpp"
#include "smlm/error.hpp"

namespace polar {

namespace {
using fitting::FitData;
using fitting::GeometricModel;
using fitting::ModelFit;
using pipeline::NamedFit;

constexpr std::size_t kFewestLocalisations = 5;
constexpr std::size_t kParticlesAStep = 16;  // of the progress

GeometricModel read_model(const FitRunOptions& o) {
  Eigen::Matrix3Xd site_nm(3, 0);
  if (!o.sites.empty()) {
    StructureFile file;
    file.path = o.sites;
    site_nm = read_structure(file).site_nm;
  }
  GeometricModel model = pipeline::load_model(o.model, site_nm);
  for (const std::string& assignment : o.hold) pipeline::hold_parameter(model, assignment);
  return model;
}

// One fit a particle, near `all` where there is one.
std::vector<NamedFit> fit_particles(const GeometricModel& model, const std::vector<FitData>& data,
                                    const std::vector<std::string>& names, const ModelFit* all,
                                    const fitting::FitOptions& options, Progress& progress) {
  std::vector<NamedFit> fits(data.size());
  for (std::size_t begin = 0; begin < data.size(); begin += kParticlesAStep) {
    progress.step("particles", static_cast<int>(begin), static_cast<int>(data.size()));
    const std::size_t end = std::min(data.size(), begin + kParticlesAStep);
    parallel_for(end - begin, [&](std::size_t k) {
      const std::size_t i = begin + k;
      fits[i].name = names[i];
      fits[i].fit.localisations = static_cast<int>(data[i].size()), fits[i].fit.groups = data[i].groups;
      if (data[i].size() < kFewestLocalisations)
        fits[i].fit.reason = data[i].size() == 0 ? "not accepted" : "fewer than 5 localisations";
      else
        fits[i].fit = all ? fitting::fit_near(model, data[i], *all, options)
                          : fitting::fit_from_starts(model, data[i], options);
    });
  }
  return fits;
}

void write_picture(const std::string& path, const smlm::LocalisationTable& table,
                   const fitting::ModelPoints& points, const ModelFit& fit) {
  const smlm::LocalisationTable drawn =
      pipeline::drawn_points(points.x_nm, points.weight, fit.value[fitting::kWidth], table);
  const Volume data = render(table);
  write_preview_png(path, {{"data", data}, {"model", render_into(data, drawn)}});
}

std::string gain_line(const char* what, const fitting::Gain& g) {
  char line[200];
  std::snprintf(line, sizeof line, "%-14s %+.4f +- %.4f nat a localisation over the model (%d particles)",
                what, g.gain, g.standard_error, g.particles);
  return line;
}

std::string spread_line(const std::string& name, const std::string& unit, std::vector<double> values) {
  if (values.empty()) return {};
  char line[200];
  const std::size_t n = values.size();
  std::snprintf(line, sizeof line, "  %-12s median %.4g, middle half %.4g to %.4g %s (%zu particles)",
                name.c_str(), quantile(values, 0.5), quantile(values, 0.25), quantile(values, 0.75),
                unit == "1" ? "" : unit.c_str(), n);
  return line;
}
}  // namespace

std::vector<std::string> fit_models() { return pipeline::shipped_models(); }

const std::vector<std::string>& fit_files() {
  static const std::vector<std::string> kFiles = {"fit.csv", "model.csv", "fit.png", "fit.json"};
  return kFiles;
}

std::vector<std::string> run_fit(const FitRunOptions& o, Progress& progress) {
  smlm::throw_if_any(violations(o.fit), smlm::Fault::usage, "polar fit");
  const GeometricModel model = read_model(o);
  const PlacedParticles particles = read_placed_particles(o.input);
  for (const std::string& warning : particles.warnings) progress.note("warning: " + warning);
  const pipeline::OutputDirectory directory(
      o.directory.empty() ? folder_beside(o.input, "fit_" + model.name) : o.directory, {o.overwrite, false});
  const std::vector<FitData> data = fitting::particles_of(particles.table, o.fit.burst_distance, o.fit.seed);

  NamedFit all{"superparticle", {}};
  const FitData together = fitting::superparticle_of(data);
  if (together.size() < kFewestLocalisations)
    throw smlm::Error(smlm::Fault::input, o.input.inputs.front(),
                      "holds fewer than 5 localisations of particles");
  progress.step("superparticle", 0, 1);
  if (particles.placed) all.fit = fitting::fit_from_starts(model, together, o.fit);
  std::vector<NamedFit> fits = fit_particles(model, data, particles.table.particle_names,
                                             particles.placed ? &all.fit : nullptr, o.fit, progress);
  if (!particles.placed &&
      std::all_of(fits.begin(), fits.end(), [](const NamedFit& f) { return f.fit.value.size() == 0; }))
    throw smlm::Error(smlm::Fault::numerical, o.input.inputs.front(), "no particle could be fitted");

  nlohmann::json json = {{"program", program_version()},
                         {"command", o.command},
                         {"model", model.name},
                         {"about", model.about},
                         {"inputs", o.input.inputs},
                         {"options",
                          {{"seed", o.fit.seed},
                           {"starts", o.fit.starts},
                           {"free_pose", o.fit.free_pose},
                           {"pose_std_deg", o.fit.pose_std_deg},
                           {"pose_std_nm", o.fit.pose_std_nm},
                           {"burst_distance", o.fit.burst_distance},
                           {"most_for_starts", o.fit.most_for_starts},
                           {"hold", o.hold}}}};
  std::vector<std::string> lines = {"model          " + model.name};
  const std::size_t fitted = static_cast<std::size_t>(
      std::count_if(fits.begin(), fits.end(), [](const NamedFit& f) { return f.fit.value.size() > 0; }));
  if (particles.placed) {
    for (const std::string& line : pipeline::fit_lines(model, all.fit)) lines.push_back(line);
    json["superparticle"] = pipeline::fit_json(model, all);
  } else if (fitted == 1) {
    const auto one =
        std::find_if(fits.begin(), fits.end(), [](const NamedFit& f) { return f.fit.value.size() > 0; });
    for (const std::string& line : pipeline::fit_lines(model, one->fit)) lines.push_back(line);
  }
  json["particles"] = nlohmann::json::array();
  for (const NamedFit& f : fits)
    if (f.fit.value.size() > 0) json["particles"].push_back(pipeline::fit_json(model, f));
  if (fitted > 1) {
    lines.push_back("particles      " + std::to_string(fitted) + " fitted, each alone:");
    for (std::size_t i = 0; i < model.parameter.size(); ++i) {
      std::vector<double> values;
      for (const NamedFit& f : fits)
        if (f.fit.value.size() > 0 && !f.fit.held[i])
          values.push_back(f.fit.value[static_cast<Eigen::Index>(i)]);
      if (!values.empty())
        lines.push_back(spread_line(model.parameter[i].name, model.parameter[i].unit, values));
    }
  }
  if (o.evidence && particles.placed && fitted > 1) {
    progress.step("evidence", 0, 1);
    fitting::FreeTemplate free;
    if (particles.sites)
      free = {particles.sites->centre_nm, particles.sites->weight, particles.sites->width_nm};
    const fitting::ModelEvidence evidence =
        judge_model(model, data, all.fit, particles.sites ? &free : nullptr, o.fit);
    json["evidence"] = pipeline::evidence_json(evidence);
    if (particles.sites) lines.push_back(gain_line("free template", evidence.free_over_common));
    lines.push_back(gain_line("each its own", evidence.own_over_common));
  }

  const ModelFit& shown = particles.placed ? all.fit : fits.front().fit;
  if (shown.value.size() > 0) {
    const fitting::ModelPoints points =
        points_of_fit(model, particles.placed ? together : data.front(), shown);
    smlm::write_file_atomically(directory.file("model.csv"), pipeline::points_csv(points));
    if (particles.placed || data.size() == 1)
      write_picture(directory.file("fit.png"), particles.table, points, shown);
  }
  if (particles.placed) fits.insert(fits.begin(), all);
  smlm::write_file_atomically(directory.file("fit.csv"), pipeline::fit_csv(model, fits));
  smlm::write_file_atomically(directory.file("fit.json"), pipeline::json_text(json));
  lines.push_back("written to     " + directory.file("fit.csv"));
  return lines;
}

}  // namespace polar
