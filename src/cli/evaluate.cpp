#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>

#include "command.hpp"
#include "polar/pipeline/simulate_run.hpp"
#include "polar/results/compare.hpp"

namespace polar::cli {

namespace {
struct Arguments {
  std::string result, truth, symmetry;
  std::vector<double> angles_deg = {5, 10, 15};
  bool json = false;
};

nlohmann::json as_json(const Comparison& c, const std::string& symmetry, double bound_deg) {
  nlohmann::json recall = nlohmann::json::array();
  for (std::size_t i = 0; i < c.angles_deg.size(); ++i)
    recall.push_back({{"angle_deg", c.angles_deg[i]},
                      {"recall", c.recall[i]},
                      {"recall_missing_as_wrong", c.recall_of_truth[i]}});
  return {{"particles", c.n_truth},
          {"compared", c.n_compared},
          {"symmetry", symmetry},
          {"pairs", c.n_pairs},
          {"pairs_sampled", c.sampled},
          {"recall", recall},
          {"median_pair_deg", c.median_pair_deg},
          {"cdf_1_to_180_deg", c.cdf},
          {"median_rotation_deg", c.median_rotation_deg},
          {"median_translation_nm", c.median_translation_nm},
          {"aligned", c.n_aligned},
          {"cramer_rao_pair_median_deg", bound_deg}};
}

void print(const Comparison& c, const std::string& symmetry, double bound_deg) {
  std::printf("particles               %zu of %zu have a pose\n", c.n_compared, c.n_truth);
  std::printf("symmetry                %s\n", symmetry.c_str());
  std::printf("pairs                   %llu%s\n", static_cast<unsigned long long>(c.n_pairs),
              c.sampled ? " (sampled)" : "");
  for (std::size_t i = 0; i < c.angles_deg.size(); ++i)
    std::printf("recall at %5.1f deg     %.4f   (missing poses as wrong: %.4f)\n", c.angles_deg[i],
                c.recall[i], c.recall_of_truth[i]);
  std::printf("median over pairs       %.3f deg\n", c.median_pair_deg);
  if (std::isfinite(bound_deg))
    std::printf("Cramer-Rao bound        %.3f deg (median over pairs)\n", bound_deg);
  std::printf("median to global motion %.3f deg, %.2f nm (%zu within %.0f deg)\n", c.median_rotation_deg,
              c.median_translation_nm, c.n_aligned, kAlignedWithin_deg);
}

int run(const Arguments& a) {
  std::error_code unseen;  // whoever opens it says why
  const std::string poses =
      std::filesystem::is_directory(a.result, unseen) ? a.result + "/poses.csv" : a.result;
  TruthSummary summary;
  summary.cramer_rao_pair_median_deg = std::nan("");
  const bool simulated = read_truth_summary(a.truth, summary);
  CompareOptions options;
  options.angles_deg = a.angles_deg;
  options.symmetry = !a.symmetry.empty() ? a.symmetry : simulated ? summary.symmetry : "none";
  const std::vector<PoseRow> estimate = read_pose_table(poses);
  const Comparison c = compare_poses(estimate, read_pose_table(a.truth), options);
  if (!c.note.empty()) std::fprintf(stderr, "note: %s\n", c.note.c_str());
  if (a.json)
    std::printf("%s\n", as_json(c, options.symmetry, summary.cramer_rao_pair_median_deg).dump(2).c_str());
  else
    print(c, options.symmetry, summary.cramer_rao_pair_median_deg);
  return 0;
}
}  // namespace

void add_evaluate(CLI::App& app, Action& action) {
  auto a = std::make_shared<Arguments>();
  CLI::App* sub = app.add_subcommand("evaluate", "Compare poses with the truth, modulo motion and symmetry");
  sub->add_option("result", a->result, "result directory or poses.csv")->required();
  sub->add_option("--truth", a->truth, "poses.csv with the true poses")->required();
  sub->add_option("--symmetry", a->symmetry,
                  "none, C<n>, D<n>, T, O, I; default: as truth.json beside the truth says");
  sub->add_option("--angles", a->angles_deg, "thresholds of the recall, degrees")->delimiter(',');
  sub->add_flag("--json", a->json, "print JSON");
  sub->callback([a, &action] { action = [a] { return run(*a); }; });
}

}  // namespace polar::cli
