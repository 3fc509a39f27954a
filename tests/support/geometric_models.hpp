// Models and particles for tests of fits.
#pragma once

#include <string>
#include <vector>

#include "polar/fitting/fit_data.hpp"
#include "polar/fitting/geometric_model.hpp"
#include "polar/results/results.hpp"
#include "polar/simulation/simulate.hpp"

namespace polar::testing {

inline fitting::Part part(fitting::Shape shape, const std::vector<std::string>& arguments,
                          const std::vector<std::string>& placement, const fitting::GeometricModel& model) {
  fitting::Part p;
  p.shape = shape;
  for (const std::string& a : arguments) p.argument.emplace_back(a, model.names());
  for (const std::string& a : placement) p.placement.emplace_back(a, model.names());
  p.placement.resize(fitting::placement_arguments().size());
  return p;
}

inline void add_parameter(fitting::GeometricModel& model, const std::string& name, double low, double high,
                          const std::string& start) {
  model.parameter.push_back({name, "nm", "", {fitting::Expression(start, {"extent"})}, low, high, false});
}

inline fitting::GeometricModel ring_model() {
  fitting::GeometricModel model = fitting::empty_model();
  model.name = "ring";
  add_parameter(model, "radius", 1, 500, "extent");
  model.part = {part(fitting::Shape::ring, {"radius"}, {}, model)};
  return model;
}

inline fitting::GeometricModel two_rings_model() {
  fitting::GeometricModel model = fitting::empty_model();
  model.name = "two_rings";
  add_parameter(model, "radius", 1, 500, "0.9 * extent");
  add_parameter(model, "distance", 0, 500, "0.9 * extent");
  model.part = {part(fitting::Shape::ring, {"radius"}, {"0", "0", "distance / 2"}, model),
                part(fitting::Shape::ring, {"radius"}, {"0", "0", "-distance / 2"}, model)};
  return model;
}

/// The simulated table moved by its true poses.
inline smlm::LocalisationTable aligned_truth(const Simulation& s) {
  std::vector<std::optional<Pose>> pose;
  for (const SimulatedParticle& p : s.particle) pose.emplace_back(p.structure_from_view);
  smlm::LocalisationTable table = aligned(smlm::group_particles(s.table), pose);
  table.planar = s.table.planar;
  return table;
}

}  // namespace polar::testing
