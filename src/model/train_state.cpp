#include "model/train_state.hpp"

#include "smlm/atomic_file.hpp"
#include "smlm/error.hpp"
#include "smlm/h5/file.hpp"

namespace polar {

namespace {
constexpr std::int64_t kVersion = 1;

std::string moments_path(std::size_t norm) { return "/moments/" + std::to_string(norm); }

std::vector<float> to_vector(const Eigen::VectorXf& v) { return {v.data(), v.data() + v.size()}; }
}  // namespace

TrainState initial_state(const TrainOptions& options) {
  TrainState state;
  state.parameters = initial_parameters(options.seed);
  state.first_moment.assign(state.parameters.size(), 0.0f);
  state.second_moment.assign(state.parameters.size(), 0.0f);
  state.moments = initial_moments();
  return state;
}

void write_checkpoint(const std::string& path, const TrainOptions& options, const TrainState& state) {
  smlm::AtomicFile file(path);
  smlm::h5::File h5 = smlm::h5::File::create(file.temporary_path());
  h5.write("/parameters", state.parameters);
  h5.write("/first_moment", state.first_moment);
  h5.write("/second_moment", state.second_moment);
  for (std::size_t i = 0; i < state.moments.size(); ++i) {
    h5.write(moments_path(i) + "/mean", to_vector(state.moments[i].mean));
    h5.write(moments_path(i) + "/variance", to_vector(state.moments[i].variance));
  }
  h5.write("/curve/step", state.curve_step);
  h5.write("/curve/loss", state.curve_loss);
  h5.write("/counters", std::vector<std::int64_t>{kVersion, static_cast<std::int64_t>(options.seed),
                                                  options.clouds_per_step, state.step,
                                                  state.reports_since_best, state.loss_steps});
  h5.write("/schedule", std::vector<double>{state.rate_factor, state.best_loss, state.loss_sum});
  h5.close();
  file.commit();
}

TrainState read_checkpoint(const std::string& path, const TrainOptions& options) {
  const smlm::h5::File h5 = smlm::h5::File::open(path);
  for (const char* object : {"/parameters", "/first_moment", "/second_moment", "/counters", "/schedule"})
    if (!h5.exists(object))
      throw smlm::Error(smlm::Fault::input, path,
                        std::string("is no training checkpoint: ") + object + " is missing",
                        "name another file in `checkpoint`");
  const auto counters = h5.read<std::int64_t>("/counters");
  const auto schedule = h5.read<double>("/schedule");
  TrainState state = initial_state(options);
  const auto read = [&](const char* object, std::vector<float>& into) {
    auto values = h5.read<float>(object);
    if (values.size() != into.size())
      throw smlm::Error(smlm::Fault::input, path, std::string(object) + " has another size than this network",
                        "start anew with another `checkpoint`");
    into = std::move(values);
  };
  if (counters.size() != 6 || counters[0] != kVersion || schedule.size() != 3)
    throw smlm::Error(smlm::Fault::input, path, "is a checkpoint of another version of this program",
                      "start anew with another `checkpoint`");
  if (counters[1] != static_cast<std::int64_t>(options.seed) || counters[2] != options.clouds_per_step)
    throw smlm::Error(smlm::Fault::usage, path,
                      "belongs to a training with seed " + std::to_string(counters[1]) + " and " +
                          std::to_string(counters[2]) + " clouds a step",
                      "use that seed and clouds_per_step, or another `checkpoint`");
  read("/parameters", state.parameters);
  read("/first_moment", state.first_moment);
  read("/second_moment", state.second_moment);
  for (std::size_t i = 0; i < state.moments.size(); ++i)
    for (auto* moment : {&state.moments[i].mean, &state.moments[i].variance}) {
      std::vector<float> values = to_vector(*moment);
      read((moments_path(i) + (moment == &state.moments[i].mean ? "/mean" : "/variance")).c_str(), values);
      *moment = Eigen::Map<const Eigen::VectorXf>(values.data(), moment->size());
    }
  state.curve_step = h5.read<std::int64_t>("/curve/step");
  state.curve_loss = h5.read<double>("/curve/loss");
  state.step = counters[3];
  state.reports_since_best = counters[4];
  state.loss_steps = counters[5];
  state.rate_factor = schedule[0];
  state.best_loss = schedule[1];
  state.loss_sum = schedule[2];
  return state;
}

}  // namespace polar
