/// \file Planes as OpenCV matrices, and back.
#pragma once

#include "core/plane.hpp"

#include <cstdint>

#include <opencv2/core.hpp>

namespace touchtrial::bench {

/// A view of a plane's samples; the plane must outlive it.
template <typename Sample>
[[nodiscard]] cv::Mat mat_of(Plane<Sample>& plane) {
  return cv::Mat(plane.height(), plane.width(), cv::traits::Type<Sample>::value,
                 plane.samples().data());
}

/// A view of an input image, to which OpenCV's functions do not write.
[[nodiscard]] inline cv::Mat mat_of(const GreyImage& image) {
  return mat_of(const_cast<GreyImage&>(image));
}

/// A copy of a matrix of one channel.
/// \param mat  of the type that belongs to Sample
template <typename Sample>
[[nodiscard]] Plane<Sample> plane_of(const cv::Mat& mat) {
  Plane<Sample> plane(mat.rows, mat.cols);
  mat.copyTo(mat_of(plane));
  return plane;
}

}  // namespace touchtrial::bench
