#include "polar/results/results.hpp"

#include <algorithm>
#include <cmath>

#include "polar/core/constants.hpp"
#include "polar/core/covariance3.hpp"
#include "polar/core/so3.hpp"

namespace polar {

std::size_t accepted_particles(const Results& results) {
  return static_cast<std::size_t>(std::count_if(results.registration.view.begin(),
                                                results.registration.view.end(),
                                                [](const RegisteredView& v) { return v.accepted; }));
}

smlm::Covariance rotated(const Eigen::Matrix3d& r, const smlm::Covariance& c) {
  return symmetric3(r * matrix(c) * r.transpose());
}

smlm::LocalisationTable rows_to_draw(const smlm::LocalisationTable& table, const std::vector<bool>& wanted) {
  smlm::LocalisationTable part;
  part.planar = table.planar;
  part.particle_names = table.particle_names;
  for (std::size_t i = 0; i < table.size(); ++i) {
    if (!wanted[i]) continue;
    part.position_nm.push_back(table.position_nm[i]);
    part.covariance_nm2.push_back(table.covariance_nm2[i]);
    part.particle.push_back(table.particle[i]);
  }
  return part;
}

smlm::LocalisationTable moved(smlm::LocalisationTable t, const Pose& pose) {
  for (std::size_t i = 0; i < t.size(); ++i) {
    const auto& x = t.position_nm[i];
    const Eigen::Vector3d y = pose * Eigen::Vector3d(x[0], x[1], t.planar ? 0.0 : x[2]);
    t.position_nm[i] = {y.x(), y.y(), t.planar ? x[2] : y.z()};
    t.covariance_nm2[i] = rotated(pose.rotation, t.covariance_nm2[i]);
  }
  return t;
}

Pose template_from_table(const Results& results, std::size_t i) {
  const Pose& engine = results.registration.view[i].template_from_view;
  const Normalisation& n = results.normalisation;
  // Products of many turns leave 1e-7, which a particle far from the table's origin shows in picometres.
  const Eigen::Matrix3d rotation = nearest_rotation(engine.rotation);
  return {rotation, n.scale_nm * engine.translation - rotation * n.centre_nm[i]};
}

Eigen::Matrix<double, 6, 6> pose_covariance_nm(const Results& results, std::size_t i) {
  Eigen::Matrix<double, 6, 1> unit;
  unit << 1, 1, 1, Eigen::Vector3d::Constant(results.normalisation.scale_nm);
  return unit.asDiagonal() * results.registration.view[i].covariance * unit.asDiagonal();
}

std::vector<PoseRow> pose_rows(const Results& results) {
  std::vector<PoseRow> rows;
  for (std::size_t i = 0; i < results.particles.particles.size(); ++i) {
    const smlm::Particle& particle = results.particles.particles[i];
    const RegisteredView& view = results.registration.view[i];
    PoseRow row;
    row.particle = particle.name;
    row.n_localisations = particle.rows.size();
    row.n_used = static_cast<std::uint64_t>(view.n_used);
    row.accepted = view.accepted;
    row.reason = view.reason;
    if (view.accepted) {
      const Eigen::Matrix<double, 6, 6> covariance = pose_covariance_nm(results, i);
      row.template_from_view = template_from_table(results, i);
      row.rotation_std_deg = kDegreesPerRadian * std::sqrt(covariance.topLeftCorner<3, 3>().trace());
      row.translation_std_nm = std::sqrt(covariance.bottomRightCorner<3, 3>().trace());
      row.log_likelihood = view.log_likelihood;
      row.margin = view.margin;
    }
    rows.push_back(row);
  }
  return rows;
}

TemplateSites template_sites(const Results& results) {
  const double scale_nm = results.normalisation.scale_nm;
  const FusedTemplate& fused = results.registration.fused;
  return {scale_nm * fused.centre, fused.weight, scale_nm * fused.width};
}

smlm::LocalisationTable aligned(const smlm::ParticleSet& particles,
                                const std::vector<std::optional<Pose>>& template_from_table) {
  const smlm::LocalisationTable& in = particles.table;
  smlm::LocalisationTable out;
  for (const smlm::Particle& p : particles.particles) out.particle_names.push_back(p.name);
  out.files = in.files;
  out.formats = in.formats;
  out.planar = in.planar;
  for (const smlm::ExtraColumn& c : in.extra) {
    out.extra.push_back(c);
    out.extra.back().values.clear();
  }
  for (std::size_t i = 0; i < particles.particles.size(); ++i) {
    if (!template_from_table[i]) continue;
    const Pose& pose = *template_from_table[i];
    for (const std::uint32_t row : particles.particles[i].rows) {
      const auto& x = in.position_nm[row];
      const Eigen::Vector3d moved = pose * Eigen::Vector3d(x[0], x[1], x[2]);
      out.position_nm.push_back({moved.x(), moved.y(), moved.z()});
      out.covariance_nm2.push_back(rotated(pose.rotation, in.covariance_nm2[row]));
      out.particle.push_back(static_cast<std::int64_t>(i));
      out.source_file.push_back(in.source_file[row]);
      out.source_row.push_back(in.source_row[row]);
      for (std::size_t c = 0; c < in.extra.size(); ++c)
        out.extra[c].values.push_back(in.extra[c].values[row]);
    }
  }
  return out;
}

smlm::LocalisationTable superparticle(const Results& results) {
  std::vector<std::optional<Pose>> pose(results.particles.particles.size());
  for (std::size_t i = 0; i < pose.size(); ++i)
    if (results.registration.view[i].accepted) pose[i] = template_from_table(results, i);
  smlm::LocalisationTable out = aligned(results.particles, pose);
  out.planar = results.planar;
  return out;
}

}  // namespace polar
