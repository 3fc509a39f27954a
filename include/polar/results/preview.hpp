// preview.png: what came out, at a glance.
#pragma once

#include <string>

#include "polar/results/render.hpp"

namespace polar {

/// Maximum projections of the volume along z, y and x side by side (planar: the one slice), each with its
/// axes' names, under one brightness scale, with a scale bar of a round length. Throws smlm::Error (io).
void write_preview_png(const std::string& path, const Volume& volume);

}  // namespace polar
