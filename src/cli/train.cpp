#include <cstdio>
#include <memory>

#include "command.hpp"
#include "polar/core/parallel.hpp"
#include "polar/model/score.hpp"
#include "polar/model/trainer.hpp"
#include "polar/model/weights_file.hpp"
#include "polar/pipeline/train_config.hpp"
#include "reporter.hpp"
#include "signals.hpp"
#include "smlm/isolation.hpp"

namespace polar::cli {

namespace {
struct Arguments {
  std::string config;
  std::vector<std::string> overrides;
  int threads = 0;
  bool score_only = false;
  bool quiet = false, json_log = false;
};

void print_scores(const TrainOptions& options) {
  if (options.score_shapes.empty()) return;
  const WeightsFile file =
      smlm::read_isolated(options.weights, [&] { return read_weights(options.weights); });
  const auto model = make_pointnet(file.weights);
  const ShapeSet shapes = read_shapes(options.score_shapes, 1024);
  std::printf("Chamfer distance on %llu shapes\n", static_cast<unsigned long long>(shapes.size()));
  for (const NamedConditions& c : standard_conditions())
    std::printf("  %-24s %.4f\n", c.name.c_str(), mean_chamfer(*model, shapes, c.conditions, options.seed));
}

int run(const Arguments& a) {
  const TrainOptions options = load_train_options(a.config, a.overrides);
  const ThreadLimit limit(a.threads);
  if (!a.score_only) {
    handle_signals();  // the step in progress ends, then a checkpoint is written
    Reporter reporter(choose_style(a.quiet, a.json_log));
    const TrainReport report = train(options, reporter);
    if (received_signal() != 0) return 128 + received_signal();
    std::printf("%lld steps, %.0f clouds/s\nweights %s\nsha256 %s\n",
                static_cast<long long>(report.steps_done), report.clouds_per_second, options.weights.c_str(),
                report.weights_sha256.c_str());
  }
  print_scores(options);
  return 0;
}
}  // namespace

void add_train(CLI::App& app, Action& action) {
  auto a = std::make_shared<Arguments>();
  CLI::App* sub = app.add_subcommand("train", "Train the autoencoder on your own or procedural structures");
  sub->add_option("config", a->config, "YAML configuration (configs/train.yaml)")->required();
  sub->add_option("--set", a->overrides, "section.key=value, wins over the file");
  sub->add_option("--threads", a->threads, "threads to use, 0: all");
  sub->add_flag("--score-only", a->score_only, "do not train: score output.weights on score.shapes");
  sub->add_flag("--quiet", a->quiet, "no progress");
  sub->add_flag("--json-log", a->json_log, "progress as JSON lines on stderr");
  sub->callback([a, &action] { action = [a] { return run(*a); }; });
}

}  // namespace polar::cli
