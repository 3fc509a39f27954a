#include "support/fake_results.hpp"

namespace polar::support {

Results perfect_results(const Simulation& simulation, const Structure& structure) {
  constexpr double kScale_nm = 100;
  Results r;
  r.planar = simulation.table.planar;
  r.particles.table = simulation.table;
  r.particles.particles.resize(simulation.particle.size());
  for (std::size_t i = 0; i < simulation.particle.size(); ++i)
    r.particles.particles[i].name = simulation.table.particle_names[i];
  for (std::uint32_t row = 0; row < simulation.table.size(); ++row)
    r.particles.particles[static_cast<std::size_t>(simulation.table.particle[row])].rows.push_back(row);
  r.normalisation.scale_nm = kScale_nm;
  for (std::size_t i = 0; i < simulation.particle.size(); ++i) {
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();
    for (const std::uint32_t row : r.particles.particles[i].rows) {
      const auto& x = simulation.table.position_nm[row];
      centre += Eigen::Vector3d(x[0], x[1], x[2]) / static_cast<double>(r.particles.particles[i].rows.size());
    }
    r.normalisation.centre_nm.push_back(centre);
    const Pose& truth = simulation.particle[i].structure_from_view;
    RegisteredView view;
    view.template_from_view = {truth.rotation, (truth.rotation * centre + truth.translation) / kScale_nm};
    view.covariance = 1e-4 * Eigen::Matrix<double, 6, 6>::Identity();
    view.log_likelihood = 1.5;
    view.margin = 0.5;
    view.n_used = static_cast<int>(r.particles.particles[i].rows.size());
    view.accepted = i != 1;
    view.reason = i == 1 ? "made up, to test" : "";
    r.registration.view.push_back(view);
  }
  r.registration.fused.centre = structure.site_nm / kScale_nm;
  r.registration.fused.weight = Eigen::VectorXd::Constant(
      structure.site_nm.cols(), 1.0 / static_cast<double>(structure.site_nm.cols()));
  r.registration.fused.width = 0.02;
  r.registration.starts = {{"random 1", -1.0, false}, {"imaged", -0.5, true}};
  r.registration.timings = {{"search", 1.25, 2.5}};
  r.registration.converged = true;
  r.registration.stopped_because = "no particle moved";
  r.provenance = {"polar test", "input:\n  files: [a.csv]\n", 7, "hash", {"HDF5"}};
  return r;
}

}  // namespace polar::support
