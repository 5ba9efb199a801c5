/// \file Conversions between NumPy arrays and the engine's planes. A plane becomes an array without
/// a copy: the array owns it. Private to python because it exposes pybind11's types.
#pragma once

#include "core/plane.hpp"

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

namespace touchtrial::python {

/// A capsule that owns a C++ object: the base of arrays that view its memory.
template <typename Owned>
[[nodiscard]] std::pair<Owned*, pybind11::capsule> owned_by_python(Owned&& object) {
  auto owner = std::make_unique<Owned>(std::forward<Owned>(object));
  pybind11::capsule base(owner.get(), [](void* pointer) { delete static_cast<Owned*>(pointer); });
  return {owner.release(), std::move(base)};
}

/// An array (H, W) that owns the plane; None for an empty one.
template <typename Sample>
[[nodiscard]] pybind11::object array_of(Plane<Sample>&& plane) {
  if (plane.empty()) return pybind11::none();
  const auto [owned, base] = owned_by_python(std::move(plane));
  return pybind11::array_t<Sample>({owned->height(), owned->width()}, owned->samples().data(),
                                   base);
}

/// Whether a picture argument is a path; otherwise it contains samples.
[[nodiscard]] bool is_path(const pybind11::handle& image);

/// A picture as 8-bit grey, converted like a file (docs/method.md, "Images").
/// \param image  a path, or an array (H, W) or (H, W, channels) of uint8 or uint16 with 1 channel
///   (grey), 2 (grey, alpha), 3 (RGB) or 4 (RGBA); rows from the top
/// \throws FileError as read_grey_image
/// \throws pybind11::type_error, value_error for other arrays
[[nodiscard]] GreyImage grey_image_of(const pybind11::handle& image);

/// \param argument  the array's name, for errors
/// \param columns  second number of the required shape (N, columns); 0: any two-dimensional shape
/// \throws pybind11::type_error unless it contains real numbers; value_error for another shape
[[nodiscard]] pybind11::array_t<double> matrix_of(const pybind11::handle& array,
                                                  const std::string& argument, int columns = 0);

/// A plane of real numbers from an array (H, W).
/// \throws as matrix_of; value_error for more than kMaxImagePixels samples
[[nodiscard]] Plane<double> plane_of(const pybind11::handle& array, const std::string& argument);

/// Makes an array read-only, because its memory is shared.
[[nodiscard]] pybind11::array read_only(pybind11::array array);

}  // namespace touchtrial::python
