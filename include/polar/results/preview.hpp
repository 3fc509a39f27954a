// preview.png: what came out, at a glance.
#pragma once

#include <string>
#include <vector>

#include "polar/results/render.hpp"

namespace polar {

/// Maximum projections of the volume along z, y and x side by side (planar: the one slice), each with its
/// axes' names, under one brightness scale, with a scale bar of a round length. Several channels, in the same
/// box, are drawn in colours that add up (green, magenta, cyan, yellow, ... in their order), each under a
/// scale of its own. Throws smlm::Error (io).
void write_preview_png(const std::string& path, const std::vector<ChannelVolume>& channels);

}  // namespace polar
