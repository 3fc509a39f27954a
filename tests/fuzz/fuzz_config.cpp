// The configurations of run, simulate and train on arbitrary bytes, which also serve as an override; whatever
// is accepted must read back to itself.
#include "input_file.hpp"
#include "pipeline/config/node.hpp"
#include "polar/pipeline/run_config.hpp"
#include "polar/pipeline/simulate_run.hpp"
#include "polar/pipeline/train_config.hpp"
#include "smlm/error.hpp"

namespace {
template <class Call>
void accept_or_refuse(const Call& call) {
  try {
    call();
  } catch (const smlm::Error&) {
  }
}

std::string written(const std::string& text) {
  return input_file(reinterpret_cast<const std::uint8_t*>(text.data()), text.size(), ".written.yaml");
}
}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string path = input_file(data, size, ".yaml");
  const std::vector<std::string> itself = {"input.files=" + path};
  accept_or_refuse([&] {
    std::string text = polar::run_config_text(polar::load_run_config(path, itself));
    require(text == polar::run_config_text(polar::load_run_config(written(text), {})));
  });
  accept_or_refuse([&] {
    std::string text = polar::simulate_config_text(polar::load_simulate_config(path, {}));
    require(text == polar::simulate_config_text(polar::load_simulate_config(written(text), {})));
  });
  accept_or_refuse([&] { polar::train_options_text(polar::load_train_options(path, {})); });
  accept_or_refuse([&] {
    polar::pipeline::Node root = polar::pipeline::parse_yaml("input: {format: csv}", "fuzz");
    polar::pipeline::apply_override(root, std::string(reinterpret_cast<const char*>(data), size));
  });
  return 0;
}
