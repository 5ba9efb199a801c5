/// \file Tables and pictures of what a sampled wall needs of hand and device.
/// Source: docs/benchmarks/closed-loop.md.
#pragma once

#include <array>
#include <string>
#include <vector>

namespace touchtrial::bench {

/// Lines of the pictures, readable for people who see few colours.
inline constexpr std::array kColours = {"#0072b2", "#d55e00", "#009e73", "#cc79a7"};

/// How every picture's gnuplot script begins.
[[nodiscard]] std::string picture_head(bool png, int width, int height);

struct WallPicture {
  std::string name;    ///< of the file, without its ending
  std::string script;  ///< for gnuplot
};

/// Prints the tables of damping and returns their pictures: by stiffness and rate, by the wall's
/// damping, by delay, and by the estimator of velocity.
[[nodiscard]] std::vector<WallPicture> wall_pictures(bool png);

/// Prints the friction that walls need whose position is read in steps, and how a device without
/// friction moves on them.
void print_quantised_walls();

/// Prints what a wall of 0.4 N/mm needs on each device model that the program ships, beside what
/// the model has.
void print_device_models();

}  // namespace touchtrial::bench
