// Every number that steers the engine, with its unit and where it comes from. "Measured": on the training
// shapes, simulated pores and half of the real ones (docs/decisions). Lengths are in particle radii (the
// scale of the views), angles in degrees, likelihoods in natural logarithms, unless a name says otherwise.
#pragma once

#include <cstdint>

namespace polar {

/// Which localisations judge: whole bursts, since the blinks of one label share its place.
struct EvidenceOptions {
  double held_out_share = 0.2;   // of a view's localisations, chosen
  double burst_distance = 3.4;   // Mahalanobis, of a localisation from the mean of its burst: 99 % of them
  int most_of_burst = 2;         // localisations of a burst that judge; chosen
  double standard_errors = 2.0;  // within which evidence does not tell two hypotheses apart; chosen
};

/// The template as the density of all posed localisations, poses as posterior samples; width and temperature
/// fall together.
struct AnnealOptions {
  double reach = 1.8, voxel = 0.075;  // of the density's cube; measured: finer costs cache, not accuracy
  double planar_voxel = 0.03;         // of the square; chosen
  int sweeps = 24;                    // of a start; measured
  double first_width = 0.25, last_width = 0.06;  // of the density; measured
  double first_beta = 0.05, last_beta = 1.0;     // inverse temperature; measured
  double narrowing = 0.8;         // share of the sweeps after which width and temperature stay; measured
  int rotations = 1000;           // of the grid over SO(3), turned in every sweep; half in the first half
  int planar_rotations = 120;     // over the circle; chosen
  int localisations = 128;        // of a view looked at; measured
  int most_localisations = 400;   // of a view that make the density; measured
  int most_judging = 80;          // of a view that judge it; chosen
  int folds = 4;                  // of the views: one is judged under the density of the others; chosen
  double unit_share = 0.5;        // of them that one asymmetric unit of a group keeps at least; measured
  double prior_share = 0.25;      // of them that registration.tilt_deg keeps at least; measured
  int most_rotations = 60000;     // of a grid that a prior or a group thins; chosen
  int first_localisations = 64;   // in the first half of the sweeps; measured
  double promising_share = 0.08;  // of the rotations whose shift is improved; measured
  double shift = 0.1;             // standard deviation of the prior of shifts; measured
  double shift_of_label = 0.5;    // what one label adds to it, over the root of the labels of a view; chosen
  int samples = 16;               // of a pose posterior; measured
  int jitters = 8;                // Metropolis steps of a sample; measured
  int last_sweeps = 3;            // over all views, when those that competed have a template; measured
  double climbing_beta = 0.3;  // from which the best rotations are climbed before they are weighed; measured
  int climbed = 6;             // best rotations that are; measured
  double same_mode_deg = 8;    // within which two climbed poses are one mode; measured
  double jitter_turn = 0.12, jitter_shift = 0.03;  // rad and radii, of a Metropolis step at beta 1; measured
  int kept = 4;                                    // samples of the last sweep that compete again; measured
  double first_outlier_fraction = 0.05;            // chosen
  double outlier_pseudo_share = 0.02;              // weight of the prior on the outlier fraction; measured
};

/// Starts that compete, and what is proposed to the best of them. More of either only while evidence tells
/// them apart.
struct ProposalOptions {
  int views = 96;        // that take part in the competition, evenly through the set; measured
  int polar_views = 32;  // that the latent start poses; the others follow its template; measured
  int fewest_starts = 2, most_starts = 4;  // random ones; measured
  double alike_deg = 15;  // within which two starts pose a view alike, up to one common rotation; chosen
  double agreeing_share = 0.9;  // of the views that two starts pose alike when they agree; chosen
  double regrown_share = 0.3;   // of the views from which a template is grown again; measured
  double regrown_width = 0.12, regrown_beta = 0.35;  // first ones of a template that is grown again; measured
  int regrown_sweeps = 10;                           // measured
  int rejected = 1;        // proposals in a row after which no more are made; measured
  int most_proposals = 4;  // chosen
  int fine_rejected = 1;   // the same of exact templates; chosen
};

/// Which groups are tried on the coarse template.
struct SymmetryOptions {
  double similarity_blur = 0.08;  // of the density whose turns are compared; measured
  double hint = 0.5;  // self-similarity from which a group is worth trying (1 the same, 0 any); chosen
  double polyhedral_hint = 0.15;  // the same of T, O and I, whose few sites a coarse template blurs; chosen
  double axial_hint = 0.4;        // the same of any turn about an axis, from which harmonics tell; measured
  int highest_order = 12;         // of an axis tried; chosen
  int orders = 3;                 // of an axis, most significant first, that are tried; measured
  double burst_distance = 1.5;    // Mahalanobis, of bursts whose azimuths are compared; measured
  double least_significance = 1;  // of a harmonic, standard errors over views; chosen
  int views = 200;                // that take part; measured
  int sweeps = 10;                // of a trial; measured
  double first_width = 0.09, first_beta = 0.35, narrowing = 0.6;  // of a trial; measured
  int draws = 4;                     // of what judges a trial; measured: one does not tell 8 from 7
  double means_standard_errors = 4;  // that a group may cost as a means, before it is tested; chosen
  double means_loss = 0.25;      // and nat a localisation that it may cost at all; measured: pores .05 to .15
  int relabellings = 8;          // tries to tell the images of a unit apart; chosen
  int relabelling_sweeps = 30;   // of one such try; chosen
  double relabelling_views = 4;  // as if seen spread evenly over the template; chosen
};

/// When a pose and a template are believed.
struct VerdictOptions {
  double least_posterior_share = 0.9;   // of a view's pose posterior within its stated spread; chosen
  double most_rotation_std_deg = 30;    // of a pose that says anything; chosen
  double most_outliers = 0.8;           // share of a view's localisations outside the template; chosen
  double held_out_share = 0.3;          // of a view's localisations that judge; measured: pores in the plane
  int draws = 4;                        // of what judges, each with its own search; chosen
  double doubtful_standard_errors = 1;  // by which it must explain more at all, or there is none; chosen
  double cloud_standard_errors = 5;     // by which a structure must explain more than a cloud; chosen
  double enough_standard_errors = 6;    // beyond which no more draws are made; chosen
  double most_gain = 0.5;  // nat a localisation over a cloud, either way, that a view counts for; measured
  double least_accepted_share = 0.3;  // of the particles when a structure counts as found; chosen
};

/// From poses to a sharp template: search, fuse, narrower as long as held-out localisations gain.
struct RefineOptions {
  double localisations_per_centre = 25;                            // of the template's mixture; measured
  int fewest_centres = 96, most_centres = 256;                     // measured
  int fewest_of_unit = 8;                                          // centres of an asymmetric unit; measured
  double first_width = 0.09, last_width = 0.03, narrowing = 0.72;  // of the template; measured
  double search_width = 0.05;        // a search looks at the template no sharper than this; measured
  int rotations = 2304;              // of the search grid; exhaustive: 50,000 (the paper's)
  int planar_rotations = 180;        // exhaustive: 720
  int basins = 8;                    // refined for every view (the paper's M); measured
  double lookup_doubt = 14;          // nat below the best by look-ups, from which no mode is refined; chosen
  int search_localisations = 128;    // of a view looked at in a search; measured
  double shift = 0.10, step = 0.06;  // of a search's translations; measured
  double planar_shift = 0.3;         // the same in the plane, where missing labels move the centre; measured
  int promising = 200;               // rotations whose shift is improved; measured
  int most_searches = 4;             // chosen
  double settled = 0.01;             // share of views that may still move when searching ends; chosen
  int localisations = 300;           // of a view while the template moves; measured
  int sweeps = 4;                    // of EM and pose steps after a search; measured
  double noise_step = 1.5;           // factor between uncertainties that are tried; chosen
  int noise_tries = 16;              // chosen
  int calibrations = 3;              // of noise and template in turn; measured
};

/// The engine, whole.
struct EngineOptions {
  EvidenceOptions evidence;
  AnnealOptions anneal;
  ProposalOptions proposals;
  SymmetryOptions symmetry;
  RefineOptions refine;
  VerdictOptions verdict;
};

}  // namespace polar
