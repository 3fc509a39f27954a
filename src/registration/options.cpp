#include <algorithm>
#include <set>

#include "polar/core/constants.hpp"
#include "polar/core/symmetry_group.hpp"
#include "polar/registration/register.hpp"

namespace polar {

namespace {

bool names_a_group(const std::string& s) { return s != "auto" && s != "none" && s != "detect"; }

void check_symmetry(const RegistrationOptions& options, std::vector<std::string>& faults) {
  const std::string& s = options.symmetry;
  if (names_a_group(s) && (!is_symmetry_group(s) || s == "C1" || s == "D1"))
    faults.push_back("registration.symmetry: '" + s +
                     "' is none of auto, none, detect, C<n> or D<n> (n from 2 to 360), T, O, I");
  if (options.method == "latent" && (names_a_group(s) || s == "detect"))
    faults.push_back("registration.symmetry: '" + s + "' needs registration.method: likelihood");
}

}  // namespace

PosePrior prior_of(const RegistrationOptions& options) {
  return {options.tilt_deg * kRadiansPerDegree, options.flip};
}

std::vector<std::string> violations(const RegistrationOptions& options) {
  std::vector<std::string> faults;
  if (options.starts.empty())
    faults.push_back("registration.starts: at least one of polar, random, imaged, template is needed");
  for (const std::string& s : options.starts)
    if (s != "polar" && s != "random" && s != "imaged" && s != "template")
      faults.push_back("registration.starts: '" + s + "' is none of polar, random, imaged, template");
  if (std::set<std::string>(options.starts.begin(), options.starts.end()).size() != options.starts.size())
    faults.push_back("registration.starts: a start is named twice");
  if (options.search != "fast" && options.search != "exhaustive")
    faults.push_back("registration.search: '" + options.search + "' is neither fast nor exhaustive");
  if (options.method != "likelihood" && options.method != "latent")
    faults.push_back("registration.method is '" + options.method + "', neither likelihood nor latent");
  if (!(options.tilt_deg >= 0 && options.tilt_deg <= 90))
    faults.push_back("registration.tilt_deg is " + std::to_string(options.tilt_deg) + ", not from 0 to 90");
  if (options.flip && options.tilt_deg == 0)
    faults.push_back(
        "registration.flip: without tilt_deg any orientation is searched anyway; give tilt_deg too");
  LatentOptions latent = options.latent;
  latent.optimizer = options.optimizer;
  for (const std::string& v : violations(latent)) faults.push_back("registration." + v);
  check_symmetry(options, faults);
  return faults;
}

bool wants(const RegistrationOptions& options, const std::string& start) {
  return std::find(options.starts.begin(), options.starts.end(), start) != options.starts.end();
}

bool needs_weights(const RegistrationOptions& options) {
  return options.method == "latent" || wants(options, "polar");
}

}  // namespace polar
