#include "app.hpp"

#include "polar/pipeline/version.hpp"

namespace polar::cli {

std::unique_ptr<CLI::App> make_app(Action& action) {
  auto app = std::make_unique<CLI::App>("polar: aligns copies of one structure in localisation microscopy");
  app->set_version_flag("--version", program_version());
  app->require_subcommand(1);
  add_run(*app, action);
  add_batch(*app, action);
  add_simulate(*app, action);
  add_export(*app, action);
  add_apply(*app, action);
  add_report(*app, action);
  add_evaluate(*app, action);
  add_fit(*app, action);
  add_modes(*app, action);
  add_inspect(*app, action);
  add_train(*app, action);
  return app;
}

}  // namespace polar::cli
