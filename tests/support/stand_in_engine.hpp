// Stands in for the engine: every view accepted where its centre of mass already is.
#pragma once

#include "polar/pipeline/run.hpp"

namespace polar::support {

inline Registration stay(const Views& views, const RegistrationOptions&, Progress&, Checkpoint&) {
  Registration r;
  r.view.resize(views.view.size());
  for (std::size_t i = 0; i < views.view.size(); ++i) {
    r.view[i].accepted = true;
    r.view[i].reason.clear();
    r.view[i].n_used = static_cast<int>(views.view[i].points.cols());
    r.view[i].template_from_view.translation = Eigen::Vector3d::Zero();
  }
  r.fused.centre = Eigen::Matrix3Xd::Zero(3, 1);
  r.fused.weight = Eigen::VectorXd::Ones(1);
  r.stopped_because = "it is a stand-in";
  return r;
}

}  // namespace polar::support
