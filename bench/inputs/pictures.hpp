/// \file The input images: the pictures that come with the program, at any size, and images that
/// are numerically hard.
#pragma once

#include "core/plane.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace touchtrial::bench {

struct Picture {
  std::string name;
  bool has_ground = false;  ///< an object on a plain ground, not a texture that fills the frame
  GreyImage image;
};

/// All pictures of stimuli/ except the flat one, 500 x 500; those that fill their frame come first.
/// \throws FileError if one is missing
[[nodiscard]] std::vector<Picture> shipped_pictures();

/// Uniform noise, a step, a checkerboard, a bright pixel, and a ramp whose CSGV lies on the branch
/// point.
/// \param size_px  their side
[[nodiscard]] std::vector<Picture> hard_images(int size_px);

/// A square of any size from a picture: its first samples, continued beyond the edge by mirror
/// images, so that there is no seam.
[[nodiscard]] GreyImage square_of(const GreyImage& picture, int size_px);

/// The picture on which times are taken: bark.png unless another is chosen.
[[nodiscard]] const GreyImage& timed_picture();
/// Chooses the timed picture.
/// \throws FileError if it cannot be read
void choose_timed_picture(const std::filesystem::path& path);

}  // namespace touchtrial::bench
