/// \file Writes NumPy .npy files (format version 1.0): row-major, little-endian.
#pragma once

#include "core/plane.hpp"

#include <filesystem>
#include <span>
#include <vector>

namespace touchtrial {

/// Writes an array. Sample is std::uint8_t, float or double.
/// \param shape  its product is the number of samples
/// \throws FileError under the conditions of write_output
template <typename Sample>
void write_npy(const std::filesystem::path& path, std::span<const Sample> samples,
               const std::vector<int>& shape);

/// Writes a plane as an array of shape (height, width).
template <typename Sample>
void write_npy(const std::filesystem::path& path, const Plane<Sample>& plane) {
  write_npy<Sample>(path, plane.samples(), {plane.height(), plane.width()});
}

}  // namespace touchtrial
