#include "python/arrays.hpp"

#include "engine/image_file.hpp"
#include "engine/image_formats/image_format.hpp"

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <new>
#include <string_view>

#include <pybind11/stl/filesystem.h>

namespace touchtrial::python {
namespace {

namespace py = pybind11;

using CStyle = std::integral_constant<int, py::array::c_style | py::array::forcecast>;

py::array asarray(const py::handle& object) {
  if (py::isinstance<py::array>(object)) return py::reinterpret_borrow<py::array>(object);
  return py::module_::import("numpy").attr("asarray")(object);
}

std::string type_of(const py::array& array) {
  return py::str(array.dtype());
}

std::string shape_of(const py::array& array) {
  return py::str(array.attr("shape"));
}

/// Called before any copy, because a broadcast array may exceed the memory.
void check_sides(const py::array& array, const std::string& argument) {
  if (array.shape(0) == 0 || array.shape(1) == 0) {
    throw py::value_error(argument + ": has shape " + shape_of(array) +
                          ", but needs at least one pixel");
  }
  const bool too_long = array.shape(0) > engine::kMaxSidePx || array.shape(1) > engine::kMaxSidePx;
  if (too_long || array.shape(0) > engine::kMaxImagePixels / array.shape(1)) {
    throw py::value_error(argument + ": has shape " + shape_of(array) + ", and exceeds a side of " +
                          std::to_string(engine::kMaxSidePx) + " or a total of " +
                          std::to_string(engine::kMaxImagePixels) + " pixels; crop or shrink it");
  }
}

template <typename Sample>
GreyImage grey_image_from(const py::array& array, int channels) {
  const auto samples = py::array_t<Sample, CStyle::value>::ensure(array);
  if (!samples) throw std::bad_alloc();
  GreyImage image(static_cast<int>(array.shape(0)), static_cast<int>(array.shape(1)));
  if constexpr (sizeof(Sample) == 1) {
    if (channels == 1) {
      std::copy_n(samples.data(), image.size(), image.samples().data());
      return image;
    }
  }
  engine::GreyScale scale{{}};
  scale.make_grey(samples.data(), channels, engine::Alpha::straight, image.samples());
  return image;
}

GreyImage grey_image_from(const py::array& array) {
  const char kind = array.dtype().kind();
  const py::ssize_t size = array.dtype().itemsize();
  if (kind != 'u' || size > 2) {
    throw py::type_error("image: has the type " + type_of(array) +
                         ", must be uint8 or uint16; scale it to 0 .. 255 and convert it with "
                         ".astype(numpy.uint8)");
  }
  const auto channels = array.ndim() == 3 ? array.shape(2) : 1;
  if (array.ndim() < 2 || array.ndim() > 3 || channels < 1 || channels > 4) {
    throw py::value_error("image: has shape " + shape_of(array) +
                          ", must be (height, width) or (height, width, channels) with 1 to 4 "
                          "channels");
  }
  check_sides(array, "image");
  return size == 1 ? grey_image_from<std::uint8_t>(array, static_cast<int>(channels))
                   : grey_image_from<std::uint16_t>(array, static_cast<int>(channels));
}

}  // namespace

bool is_path(const py::handle& image) {
  if (py::isinstance<py::array>(image)) return false;
  return py::isinstance<py::str>(image) || py::isinstance<py::bytes>(image) ||
         py::hasattr(image, "__fspath__");
}

GreyImage grey_image_of(const py::handle& image) {
  if (!is_path(image)) return grey_image_from(asarray(image));
  const auto path = image.cast<std::filesystem::path>();
  const py::gil_scoped_release gil_released;
  return engine::read_grey_image(path);
}

py::array_t<double> matrix_of(const py::handle& object, const std::string& argument, int columns) {
  const py::array array = asarray(object);
  if (std::string_view("fiu").find(array.dtype().kind()) == std::string_view::npos) {
    throw py::type_error(argument + ": has the type " + type_of(array) + ", must be real numbers");
  }
  if (array.ndim() != 2 || (columns > 0 && array.shape(1) != columns)) {
    throw py::value_error(
        argument + ": has shape " + shape_of(array) + ", must be " +
        (columns > 0 ? "(N, " + std::to_string(columns) + ")" : "(height, width)"));
  }
  if (columns == 0) check_sides(array, argument);
  auto matrix = py::array_t<double, CStyle::value>::ensure(array);
  if (!matrix) throw std::bad_alloc();
  return matrix;
}

Plane<double> plane_of(const py::handle& array, const std::string& argument) {
  const py::array_t<double> matrix = matrix_of(array, argument);
  Plane<double> plane(static_cast<int>(matrix.shape(0)), static_cast<int>(matrix.shape(1)));
  std::copy_n(matrix.data(), plane.size(), plane.samples().data());
  return plane;
}

py::array read_only(py::array array) {
  array.attr("setflags")(py::arg("write") = false);
  return array;
}

}  // namespace touchtrial::python
