// The expert section: every field of the engine's options, under its own name.
#pragma once

#include "polar/registration/engine_options.hpp"

namespace polar::pipeline {

template <class Section>
void engine_fields(Section& expert, EngineOptions& o) {
  expert.section("evidence", [&](auto& s) {
    s.field("held_out_share", o.evidence.held_out_share);
    s.field("burst_distance", o.evidence.burst_distance);
    s.field("most_of_burst", o.evidence.most_of_burst);
    s.field("standard_errors", o.evidence.standard_errors);
  });
  expert.section("anneal", [&](auto& s) {
    s.field("reach", o.anneal.reach);
    s.field("voxel", o.anneal.voxel);
    s.field("planar_voxel", o.anneal.planar_voxel);
    s.field("sweeps", o.anneal.sweeps);
    s.field("first_width", o.anneal.first_width);
    s.field("last_width", o.anneal.last_width);
    s.field("first_beta", o.anneal.first_beta);
    s.field("last_beta", o.anneal.last_beta);
    s.field("narrowing", o.anneal.narrowing);
    s.field("rotations", o.anneal.rotations);
    s.field("planar_rotations", o.anneal.planar_rotations);
    s.field("localisations", o.anneal.localisations);
    s.field("most_localisations", o.anneal.most_localisations);
    s.field("most_judging", o.anneal.most_judging);
    s.field("folds", o.anneal.folds);
    s.field("unit_share", o.anneal.unit_share);
    s.field("prior_share", o.anneal.prior_share);
    s.field("most_rotations", o.anneal.most_rotations);
    s.field("first_localisations", o.anneal.first_localisations);
    s.field("promising_share", o.anneal.promising_share);
    s.field("shift", o.anneal.shift);
    s.field("shift_of_label", o.anneal.shift_of_label);
    s.field("samples", o.anneal.samples);
    s.field("jitters", o.anneal.jitters);
    s.field("last_sweeps", o.anneal.last_sweeps);
    s.field("climbing_beta", o.anneal.climbing_beta);
    s.field("climbed", o.anneal.climbed);
    s.field("same_mode_deg", o.anneal.same_mode_deg);
    s.field("jitter_turn", o.anneal.jitter_turn);
    s.field("jitter_shift", o.anneal.jitter_shift);
    s.field("kept", o.anneal.kept);
    s.field("first_outlier_fraction", o.anneal.first_outlier_fraction);
    s.field("outlier_pseudo_share", o.anneal.outlier_pseudo_share);
  });
  expert.section("proposals", [&](auto& s) {
    s.field("views", o.proposals.views);
    s.field("polar_views", o.proposals.polar_views);
    s.field("fewest_starts", o.proposals.fewest_starts);
    s.field("most_starts", o.proposals.most_starts);
    s.field("alike_deg", o.proposals.alike_deg);
    s.field("agreeing_share", o.proposals.agreeing_share);
    s.field("regrown_share", o.proposals.regrown_share);
    s.field("regrown_width", o.proposals.regrown_width);
    s.field("regrown_beta", o.proposals.regrown_beta);
    s.field("regrown_sweeps", o.proposals.regrown_sweeps);
    s.field("rejected", o.proposals.rejected);
    s.field("most_proposals", o.proposals.most_proposals);
    s.field("fine_rejected", o.proposals.fine_rejected);
  });
  expert.section("symmetry", [&](auto& s) {
    s.field("similarity_blur", o.symmetry.similarity_blur);
    s.field("hint", o.symmetry.hint);
    s.field("polyhedral_hint", o.symmetry.polyhedral_hint);
    s.field("axial_hint", o.symmetry.axial_hint);
    s.field("highest_order", o.symmetry.highest_order);
    s.field("orders", o.symmetry.orders);
    s.field("burst_distance", o.symmetry.burst_distance);
    s.field("least_significance", o.symmetry.least_significance);
    s.field("views", o.symmetry.views);
    s.field("sweeps", o.symmetry.sweeps);
    s.field("first_width", o.symmetry.first_width);
    s.field("first_beta", o.symmetry.first_beta);
    s.field("narrowing", o.symmetry.narrowing);
    s.field("draws", o.symmetry.draws);
    s.field("means_standard_errors", o.symmetry.means_standard_errors);
    s.field("means_loss", o.symmetry.means_loss);
    s.field("relabellings", o.symmetry.relabellings);
    s.field("relabelling_sweeps", o.symmetry.relabelling_sweeps);
    s.field("relabelling_views", o.symmetry.relabelling_views);
  });
  expert.section("refine", [&](auto& s) {
    s.field("localisations_per_centre", o.refine.localisations_per_centre);
    s.field("fewest_centres", o.refine.fewest_centres);
    s.field("most_centres", o.refine.most_centres);
    s.field("fewest_of_unit", o.refine.fewest_of_unit);
    s.field("first_width", o.refine.first_width);
    s.field("last_width", o.refine.last_width);
    s.field("narrowing", o.refine.narrowing);
    s.field("search_width", o.refine.search_width);
    s.field("rotations", o.refine.rotations);
    s.field("planar_rotations", o.refine.planar_rotations);
    s.field("basins", o.refine.basins);
    s.field("lookup_doubt", o.refine.lookup_doubt);
    s.field("search_localisations", o.refine.search_localisations);
    s.field("shift", o.refine.shift);
    s.field("step", o.refine.step);
    s.field("planar_shift", o.refine.planar_shift);
    s.field("promising", o.refine.promising);
    s.field("most_searches", o.refine.most_searches);
    s.field("settled", o.refine.settled);
    s.field("localisations", o.refine.localisations);
    s.field("sweeps", o.refine.sweeps);
    s.field("noise_step", o.refine.noise_step);
    s.field("noise_tries", o.refine.noise_tries);
    s.field("calibrations", o.refine.calibrations);
  });
  expert.section("verdict", [&](auto& s) {
    s.field("least_posterior_share", o.verdict.least_posterior_share);
    s.field("most_rotation_std_deg", o.verdict.most_rotation_std_deg);
    s.field("most_outliers", o.verdict.most_outliers);
    s.field("held_out_share", o.verdict.held_out_share);
    s.field("draws", o.verdict.draws);
    s.field("doubtful_standard_errors", o.verdict.doubtful_standard_errors);
    s.field("cloud_standard_errors", o.verdict.cloud_standard_errors);
    s.field("enough_standard_errors", o.verdict.enough_standard_errors);
    s.field("most_gain", o.verdict.most_gain);
    s.field("least_accepted_share", o.verdict.least_accepted_share);
  });
}

}  // namespace polar::pipeline
