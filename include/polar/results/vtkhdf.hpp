// Files for ParaView (VTKHDF 1.0, as ParaView 5.11 reads it: extension .hdf) and, for the volume, Fiji.
#pragma once

#include <string>
#include <vector>

#include "polar/results/render.hpp"
#include "smlm/localisation_table.hpp"

namespace polar {

/// aligned.hdf: UnstructuredGrid, one vertex a localisation, positions in nm; every column as a point array.
void write_points_vtkhdf(const std::string& path, const smlm::LocalisationTable& table);

/// template.hdf: ImageData, PointData/density float32 in z, y, x order; spacing in nm, and the attribute
/// element_size_um (z, y, x) that Fiji's HDF5 reader asks for.
/// Channels, in the same box, are further arrays `density_<name>`.
void write_volume_vtkhdf(const std::string& path, const Volume& volume,
                         const std::vector<ChannelVolume>& channels = {});

}  // namespace polar
