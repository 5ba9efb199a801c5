/// \file The images that are worked on: the pictures that come with the program, at any size, and
/// images that are hard on the arithmetic.
#pragma once

#include "core/plane.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace touchtrial::bench {

struct Picture {
  std::string name;
  bool has_ground = false;  ///< an object on a plain ground: no photograph of a texture
  GreyImage image;
};

/// The pictures of stimuli/ but the flat one, 500 x 500; those that fill their frame first.
/// \throws FileError if one is missing
[[nodiscard]] std::vector<Picture> shipped_pictures();

/// Uniform noise, a step, a checkerboard, a bright pixel and a ramp whose CSGV lies on the branch
/// point: what pictures seldom are. \param size_px  their side
[[nodiscard]] std::vector<Picture> hard_images(int size_px);

/// A square of any size out of a picture: its first samples, and beyond its edge its mirror image,
/// so that there is no seam.
[[nodiscard]] GreyImage square_of(const GreyImage& picture, int size_px);

/// The picture that times are taken on; bark.png unless another was chosen.
[[nodiscard]] const GreyImage& timed_picture();
/// Chooses it. \throws FileError if it cannot be read
void choose_timed_picture(const std::filesystem::path& path);

}  // namespace touchtrial::bench
