// How often registration is right, where it is hard: one line a case. Two runs a case, one from nothing and
// one from the true poses, tell a search that failed (the truth scores better) from data that cannot say
// (it does not). Usage: --help; what it is for: docs/results.md.
#include <sys/resource.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <functional>
#include <iostream>
#include <string>
#include <vector>

#include "polar/registration/prepare.hpp"
#include "polar/registration/register.hpp"
#include "polar/results/compare.hpp"
#include "polar/results/results.hpp"
#include "polar/simulation/simulate.hpp"
#include "polar/simulation/structure_file.hpp"
#include "smlm/error.hpp"
#include "smlm/h5/file.hpp"

namespace polar {
namespace {

constexpr double kRadius_nm = 100;  // a shape of radius 1 becomes one of this radius
constexpr int kViews = 50;
constexpr double kRight_deg = 10;  // of a view, from where the consensus motion puts it

struct Shape {
  const char* name;
  std::uint64_t index;  // in princeton_shape_benchmark_dev.h5
};
constexpr Shape kShapes[] = {
    {"tree", 256}, {"two_story_home", 128}, {"fish", 16}, {"helicopter", 349}, {"desk_chair", 210}};

struct Case {
  const char* name;
  double points = 1024;
  double sigma = 0.02;  // of a localisation, in shape radii, x and y
  double axial_factor = 1;
  double visibility = 1;
  double strands = 0;  // share of the localisations
};
constexpr Case kCases[] = {{"noise_0.15", 1024, 0.15},
                           {"anisotropic_0.05_0.2", 1024, 0.05, 4},
                           {"visibility_0.5", 1024, 0.02, 1, 0.5},
                           {"visibility_0.3", 1024, 0.02, 1, 0.3},
                           {"strands_0.4", 1024, 0.02, 1, 1, 0.4},
                           {"strands_0.6", 1024, 0.02, 1, 1, 0.6},
                           {"points_200", 200, 0.05},
                           {"points_50", 50, 0.05}};

SimulationOptions options_of(const Case& c, std::uint64_t draw) {
  SimulationOptions o;
  o.seed = draw;
  o.particles = kViews;
  o.sampling = "points";
  o.points = {c.points, c.points};
  o.label_size_nm = 0;
  o.sigma_xy_nm = {c.sigma * kRadius_nm, c.sigma * kRadius_nm};
  o.sigma_z_factor = {c.axial_factor, c.axial_factor};
  o.visibility = {c.visibility, c.visibility};
  o.outlier_fraction = c.strands;
  o.outliers = "strands";
  o.translation_nm = 0.2 * kRadius_nm;
  o.cramer_rao = false;
  return o;
}

/// Particles with the true pose of each, structure from table coordinates in nm.
struct Task {
  smlm::ParticleSet particles;
  std::vector<Pose> truth_nm;
};

Task simulated(const Structure& structure, const Case& c, std::uint64_t draw) {
  Simulation s = simulate(structure, options_of(c, draw));
  Task task;
  for (const SimulatedParticle& p : s.particle) task.truth_nm.push_back(p.structure_from_view);
  task.particles = smlm::group_particles(std::move(s.table));
  return task;
}

/// A group of polar_sample.h5: views x points x 3 of a template of radius 1, sigmas in the frame of the view.
Task sampled(const std::string& path, const std::string& group, std::size_t most_views) {
  const auto h5 = smlm::h5::File::open(path);
  const auto shape = h5.info("/" + group).shape;
  const auto flat = h5.read<double>("/" + group);
  const auto sigma = h5.read_attribute<double>("/" + group, "sigmas");
  const auto turn = h5.read<double>("/R");
  smlm::LocalisationTable table;
  table.files = table.formats = {path};
  smlm::Covariance covariance{};
  for (std::size_t a = 0; a < 3; ++a)
    covariance[a == 0 ? 0 : 2 * a + 1] = static_cast<float>(std::pow(sigma[a] * kRadius_nm, 2));
  Task task;
  for (std::size_t i = 0; i < std::min<std::size_t>(shape[0], most_views); ++i) {
    table.particle_names.push_back(std::to_string(i + 1));
    for (std::size_t j = 0; j < shape[1]; ++j) {
      const double* x = &flat[(i * shape[1] + j) * 3];
      table.position_nm.push_back({kRadius_nm * x[0], kRadius_nm * x[1], kRadius_nm * x[2]});
      table.covariance_nm2.push_back(covariance);
      table.particle.push_back(static_cast<std::int64_t>(i));
      table.source_file.push_back(0);
      table.source_row.push_back(table.size());
    }
    // view = template R for row vectors, so template = R view for columns. The shift is not on file.
    Pose pose;
    for (int e = 0; e < 9; ++e) pose.rotation(e / 3, e % 3) = turn[9 * i + static_cast<std::size_t>(e)];
    task.truth_nm.push_back(pose);
  }
  task.particles = smlm::group_particles(std::move(table));
  return task;
}

/// The pose of the normalised view, template in units of the scale.
Pose normalised(const Pose& structure_from_table_nm, const Normalisation& n, std::size_t i) {
  return {structure_from_table_nm.rotation, structure_from_table_nm * n.centre_nm[i] / n.scale_nm};
}

struct Outcome {
  Registration registration;
  Comparison comparison;
  double seconds = 0, processor_seconds = 0;  // the latter of all threads: what other work cannot change
  std::size_t right = 0;
  double log_likelihood = 0;  // mean over views of the mean per localisation

  std::string winner() const {
    for (const StartReport& s : registration.starts)
      if (s.won) return s.name;
    return "-";
  }
  bool is_right(std::size_t i) const { return comparison.particle[i].rotation_deg <= kRight_deg; }
};

/// Runs `work` on the prepared views and compares every pose it gives, accepted or not.
Outcome measured(const Task& task, const std::function<Registration(const Views&)>& work) {
  const auto start = std::chrono::steady_clock::now();
  const std::clock_t spent = std::clock();
  const Views views = prepare_views(task.particles);
  Results results;
  results.registration = work(views);
  Outcome out;
  out.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  out.processor_seconds = static_cast<double>(std::clock() - spent) / CLOCKS_PER_SEC;
  results.normalisation = views.normalisation;
  std::vector<PoseRow> estimate, truth;
  for (std::size_t i = 0; i < task.truth_nm.size(); ++i) {
    PoseRow row;
    row.particle = task.particles.particles[i].name;
    row.accepted = true;
    row.template_from_view = task.truth_nm[i];
    truth.push_back(row);
    row.template_from_view = template_from_table(results, i);
    estimate.push_back(row);
    out.log_likelihood +=
        results.registration.view[i].log_likelihood / static_cast<double>(task.truth_nm.size());
  }
  out.comparison = compare_poses(estimate, truth, {});
  for (std::size_t i = 0; i < truth.size(); ++i) out.right += out.is_right(i) ? 1 : 0;
  out.registration = std::move(results.registration);
  return out;
}

void hard_case(const Shape& shape, const Structure& structure, const Case& c, std::uint64_t draw,
               const RegistrationOptions& options) {
  const Task task = simulated(structure, c, draw);
  Progress silent;
  const Outcome found = measured(task, [&](const Views& v) { return register_views(v, options, silent); });
  const Outcome from_truth = measured(task, [&](const Views& v) {
    std::vector<Pose> poses;
    for (std::size_t i = 0; i < task.truth_nm.size(); ++i)
      poses.push_back(normalised(task.truth_nm[i], v.normalisation, i));
    return register_from(v, poses, options, silent);
  });
  int failed = 0, ambiguous = 0;
  for (std::size_t i = 0; i < task.truth_nm.size(); ++i) {
    if (found.is_right(i)) continue;
    const bool worse =
        found.registration.view[i].log_likelihood < from_truth.registration.view[i].log_likelihood;
    ++(worse ? failed : ambiguous);
  }
  std::printf("| %s | %s | %.3f | %.3f | %.2f | %zu | %zu | %.3f | %.3f | %d | %d | %s | %.1f | %.1f |\n",
              shape.name, c.name, found.comparison.recall[0], found.comparison.recall[1],
              found.comparison.median_pair_deg, found.right, from_truth.right, found.log_likelihood,
              from_truth.log_likelihood, failed, ambiguous, found.winner().c_str(), found.seconds,
              found.processor_seconds);
  std::fflush(stdout);
}

void print_sample_row(const std::string& group, const std::string& search, std::uint64_t seed,
                      const Outcome& o) {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  std::printf("| %s | %s | %llu | %.4f | %.4f | %.4f | %.2f | %s | %.1f | %.1f | %.0f |\n", group.c_str(),
              search.c_str(), static_cast<unsigned long long>(seed), o.comparison.recall[0],
              o.comparison.recall[1], o.comparison.recall[2], o.comparison.median_pair_deg,
              o.winner().c_str(), o.seconds, o.processor_seconds,
              static_cast<double>(usage.ru_maxrss) / 1024);
  std::fflush(stdout);
}

/// With `then_likelihood` a second row: the default registration by likelihood from the poses of the first.
void sample_case(const std::string& path, const std::string& group, std::uint64_t first_seed,
                 std::uint64_t seeds, std::size_t most_views, bool then_likelihood,
                 RegistrationOptions options) {
  const Task task = sampled(path, group, most_views);
  Progress silent;
  for (options.seed = first_seed; options.seed <= seeds; ++options.seed) {
    const Outcome o = measured(task, [&](const Views& v) { return register_views(v, options, silent); });
    print_sample_row(group, options.search, options.seed, o);
    if (!then_likelihood) continue;
    RegistrationOptions likelihood;
    likelihood.seed = options.seed;
    std::vector<Pose> poses;
    for (const RegisteredView& view : o.registration.view) poses.push_back(view.template_from_view);
    const Outcome after =
        measured(task, [&](const Views& v) { return register_from(v, poses, likelihood, silent); });
    print_sample_row(group, "then likelihood", options.seed, after);
  }
}

bool chosen(const std::vector<std::string>& names, const std::string& name) {
  return names.empty() || std::find(names.begin(), names.end(), name) != names.end();
}

}  // namespace
}  // namespace polar

int main(int argc, char** argv) {
  using namespace polar;
  CLI::App app("Recall of registration in hard cases, and on polar_sample.h5");
  std::string folder, sample;
  std::vector<std::string> shapes, cases;
  std::uint64_t first_seed = 1, seeds = 3, draw = 1;
  std::size_t most_views = 100;
  bool then_likelihood = false;
  RegistrationOptions options;
  app.add_option("folder", folder, "folder of princeton_shape_benchmark_dev.h5");
  app.add_option("--sample", sample, "polar_sample.h5: its two groups");
  app.add_option("--first-seed", first_seed, "of the sample");
  app.add_option("--seeds", seeds, "seeds up to this one, of the sample");
  app.add_option("--draw", draw, "seed of the views that are drawn of a shape");
  app.add_option("--shape", shapes, "only these shapes");
  app.add_option("--case", cases, "only these cases or groups");
  app.add_option("--search", options.search, "fast | exhaustive");
  app.add_option("--start", options.starts, "only these starts");
  app.add_option("--method", options.method, "likelihood | latent");
  app.add_option("--optimizer", options.optimizer, "levenberg_marquardt | adamw");
  app.add_option("--visibility", options.latent.visibility, "of the latent registration");
  app.add_option("--outliers", options.latent.outlier_fraction, "of the latent registration");
  app.add_option("--template", options.latent.template_kind, "of the latent registration: fused | decoded");
  app.add_option("--noise", options.latent.noise, "per_localisation | common | none");
  app.add_option("--localisations", options.latent.localisations, "of a view in the latent registration");
  app.add_option("--rotations", options.latent.rotations, "of the latent registration's grid");
  app.add_option("--basins", options.latent.basins, "of the latent registration's multistart");
  app.add_option("--medoids", options.latent.medoids, "first templates of the latent registration");
  app.add_option("--matched", options.latent.matched_counts, "as many template points as localisations");
  app.add_option("--loops", options.latent.most_loops, "of the latent registration");
  app.add_option("--views", most_views, "of each group of the sample, at most");
  app.add_flag("--then-likelihood", then_likelihood,
               "and the likelihood from the poses found, of the sample");
  CLI11_PARSE(app, argc, argv);
  try {
    const std::vector<std::string> faults = violations(options);
    if (!faults.empty()) throw smlm::Error(smlm::Fault::usage, "--search", faults.front());
    if (!sample.empty()) {
      std::puts(
          "| group | search | seed | recall 5 deg | recall 10 deg | recall 15 deg | median deg | winner "
          "| s | processor s | peak MiB |");
      std::puts("|---|---|---|---|---|---|---|---|---|---|---|");
      for (const char* group : {"anisotropy", "cropped_noisy"})
        if (chosen(cases, group))
          sample_case(sample, group, first_seed, seeds, most_views, then_likelihood, options);
    }
    if (folder.empty()) return 0;
    std::puts(
        "| shape | case | recall 5 deg | recall 10 deg | median deg | right | right from truth | log "
        "likelihood | from truth | failed search | ambiguous | winner | s | processor s |");
    std::puts("|---|---|---|---|---|---|---|---|---|---|---|---|---|---|");
    for (const Case& c : kCases) {
      if (!chosen(cases, c.name)) continue;
      for (const Shape& shape : kShapes) {
        if (!chosen(shapes, shape.name)) continue;
        const Structure structure =
            read_structure({folder + "/princeton_shape_benchmark_dev.h5", "", shape.index, kRadius_nm});
        hard_case(shape, structure, c, draw, options);
      }
    }
  } catch (const smlm::Error& error) {
    std::cerr << error.what() << '\n';
    return 1;
  }
  return 0;
}
