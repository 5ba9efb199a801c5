#include "engine/pictures/force_arrows.hpp"

#include "core/errors.hpp"
#include "core/outputs.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <vector>

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

namespace touchtrial::engine {
namespace {

constexpr int kPanel_px = 720;
constexpr int kMargin_px = 24;
constexpr int kSubpixelBits = 4;
/// The maximum length of 95 % of the arrows, in pixels of the texture, so that neighbours in a row
/// do not touch.
constexpr double kLongArrow_px = 0.95;
constexpr double kMinArrow_px = 0.06;

const cv::Scalar kWhite(255, 255, 255);
const cv::Scalar kArrowColour(0, 60, 230);  // blue, green, red

double norm_at(const ForceField<double>& force, int y, int x) {
  return std::hypot(force.x.at(y, x), force.y.at(y, x));
}

/// sums(y, x) is the sum of the squared forces above and left of (y, x).
cv::Mat integral_of_squares(const ForceField<double>& force) {
  cv::Mat squares(force.x.height(), force.x.width(), CV_64F);
  for (int y = 0; y < squares.rows; ++y) {
    for (int x = 0; x < squares.cols; ++x) {
      const double norm = norm_at(force, y, x);
      squares.at<double>(y, x) = norm * norm;
    }
  }
  cv::Mat sums;
  cv::integral(squares, sums, CV_64F);
  return sums;
}

double sum_over_patch(const cv::Mat& sums, const ArrowPatch& patch) {
  const int bottom = patch.y + patch.height;
  const int right = patch.x + patch.width;
  return sums.at<double>(bottom, right) - sums.at<double>(patch.y, right) -
         sums.at<double>(bottom, patch.x) + sums.at<double>(patch.y, patch.x);
}

/// The 95th percentile of the patch's forces, or the largest force if that is 0.
double long_force_in(const ForceField<double>& force, const ArrowPatch& patch) {
  std::vector<double> norms;
  for (int y = patch.y; y < patch.y + patch.height; ++y) {
    for (int x = patch.x; x < patch.x + patch.width; ++x) norms.push_back(norm_at(force, y, x));
  }
  const auto percentile = norms.begin() + static_cast<std::ptrdiff_t>(norms.size() * 19 / 20);
  std::nth_element(norms.begin(), percentile, norms.end());
  return *percentile > 0.0 ? *percentile : *std::max_element(norms.begin(), norms.end());
}

cv::Mat resize_picture(const cv::Mat& picture, double scale) {
  cv::Mat result;
  const cv::Size size(std::max(1, static_cast<int>(std::lround(picture.cols * scale))),
                      std::max(1, static_cast<int>(std::lround(picture.rows * scale))));
  cv::resize(picture, result, size, 0, 0, scale < 1.0 ? cv::INTER_AREA : cv::INTER_NEAREST);
  return result;
}

/// A point in units of 1 / 2^kSubpixelBits output pixels; the centre of the first output pixel is
/// 0.
cv::Point subpixel(double x, double y, double scale) {
  const double units = 1 << kSubpixelBits;
  return {static_cast<int>(std::lround((x * scale - 0.5) * units)),
          static_cast<int>(std::lround((y * scale - 0.5) * units))};
}

void draw_arrows(cv::Mat& canvas, const ForceField<double>& force, const ArrowPatch& patch,
                 double scale) {
  if (patch.force_of_unit_arrow <= 0.0) return;
  for (int y = 0; y < patch.height; ++y) {
    for (int x = 0; x < patch.width; ++x) {
      const double dx = force.x.at(patch.y + y, patch.x + x) / patch.force_of_unit_arrow;
      const double dy = force.y.at(patch.y + y, patch.x + x) / patch.force_of_unit_arrow;
      if (std::hypot(dx, dy) < kMinArrow_px) continue;
      cv::arrowedLine(canvas, subpixel(x + 0.5 - dx / 2, y + 0.5 - dy / 2, scale),
                      subpixel(x + 0.5 + dx / 2, y + 0.5 + dy / 2, scale), kArrowColour, 2,
                      cv::LINE_AA, kSubpixelBits, 0.3);
    }
  }
}

/// Draws the texture in the middle of a panel, with a frame around the patch.
cv::Mat draw_overview(const cv::Mat& texture, const ArrowPatch& patch) {
  const double scale = static_cast<double>(kPanel_px) / std::max(texture.rows, texture.cols);
  cv::Mat panel(kPanel_px, kPanel_px, CV_8UC3, kWhite);
  cv::Mat picture = resize_picture(texture, scale);
  const cv::Point frame_corner(static_cast<int>(patch.x * scale),
                               static_cast<int>(patch.y * scale));
  const cv::Size size(static_cast<int>(std::ceil(patch.width * scale)),
                      static_cast<int>(std::ceil(patch.height * scale)));
  cv::rectangle(picture, cv::Rect(frame_corner, size), kArrowColour, 3);
  picture.copyTo(panel(cv::Rect((kPanel_px - picture.cols) / 2, (kPanel_px - picture.rows) / 2,
                                picture.cols, picture.rows)));
  return panel;
}

cv::Mat draw_close_up(const cv::Mat& texture, const ForceField<double>& force,
                      const ArrowPatch& patch, int side_px) {
  const double scale = static_cast<double>(side_px) / std::max(patch.height, patch.width);
  cv::Mat panel(side_px, side_px, CV_8UC3, kWhite);
  cv::Mat picture =
      resize_picture(texture(cv::Rect(patch.x, patch.y, patch.width, patch.height)), scale);
  draw_arrows(picture, force, patch, scale);
  picture.copyTo(panel(cv::Rect((side_px - picture.cols) / 2, (side_px - picture.rows) / 2,
                                picture.cols, picture.rows)));
  return panel;
}

cv::Mat to_colour(const GreyImage& image) {
  cv::Mat grey(image.height(), image.width(), CV_8UC1);
  for (int y = 0; y < image.height(); ++y) {
    std::copy(image.row(y).begin(), image.row(y).end(), grey.ptr(y));
  }
  cv::Mat colour;
  cv::cvtColor(grey, colour, cv::COLOR_GRAY2BGR);
  return colour;
}

cv::Mat draw_two_panels(const GreyImage& texture, const ForceField<double>& force,
                        const ArrowPatch& patch) {
  const cv::Mat picture = to_colour(texture);
  cv::Mat sheet(kPanel_px, 2 * kPanel_px + kMargin_px, CV_8UC3, kWhite);
  draw_overview(picture, patch).copyTo(sheet(cv::Rect(0, 0, kPanel_px, kPanel_px)));
  draw_close_up(picture, force, patch, kPanel_px)
      .copyTo(sheet(cv::Rect(kPanel_px + kMargin_px, 0, kPanel_px, kPanel_px)));
  return sheet;
}

ColourImage to_colour_image(const cv::Mat& picture) {
  ColourImage image(picture.rows, picture.cols);
  for (int y = 0; y < picture.rows; ++y) {
    for (int x = 0; x < picture.cols; ++x) {
      const auto& pixel = picture.at<cv::Vec3b>(y, x);
      image.at(y, x) = {pixel[2], pixel[1], pixel[0]};
    }
  }
  return image;
}

void require_same_shape(const GreyImage& texture, const ForceField<double>& force,
                        const char* caller) {
  if (texture.height() == force.x.height() && texture.width() == force.x.width()) return;
  throw std::invalid_argument(std::string(caller) + ": texture and field differ in size");
}

}  // namespace

ArrowPatch strongest_patch(const ForceField<double>& force) {
  if (force.x.empty()) throw std::invalid_argument("strongest_patch: the field is empty");
  const int height = std::min(kArrowPatchSide_px, force.x.height());
  const int width = std::min(kArrowPatchSide_px, force.x.width());
  const cv::Mat sums = integral_of_squares(force);
  ArrowPatch best{(force.x.height() - height) / 2, (force.x.width() - width) / 2, height, width,
                  0.0};
  double max_sum = 0.0;
  for (int y = 0; y + height <= force.x.height(); ++y) {
    for (int x = 0; x + width <= force.x.width(); ++x) {
      const ArrowPatch patch{y, x, height, width, 0.0};
      const double sum = sum_over_patch(sums, patch);
      if (sum <= max_sum) continue;
      max_sum = sum;
      best = patch;
    }
  }
  best.force_of_unit_arrow = long_force_in(force, best) / kLongArrow_px;
  return best;
}

ColourImage force_arrows(const GreyImage& texture, const ForceField<double>& force,
                         const ArrowPatch& patch, int side_px) {
  require_same_shape(texture, force, "force_arrows");
  const bool is_inside = patch.y >= 0 && patch.x >= 0 && patch.height >= 1 && patch.width >= 1 &&
                         patch.height <= texture.height() - patch.y &&
                         patch.width <= texture.width() - patch.x;
  if (!is_inside || side_px < 1) {
    throw std::invalid_argument(
        "force_arrows: the patch is outside the texture, or side_px is below 1");
  }
  return to_colour_image(draw_close_up(to_colour(texture), force, patch, side_px));
}

ArrowPatch write_force_arrows(const std::filesystem::path& path, const GreyImage& texture,
                              const ForceField<double>& force) {
  require_same_shape(texture, force, "write_force_arrows");
  const ArrowPatch patch = strongest_patch(force);
  Bytes bytes;
  try {
    bytes = png_bytes(to_colour_image(draw_two_panels(texture, force, patch)));
  } catch (const FileError& error) {
    throw FileError(one_line(path.string()) + ": " + error.what());
  }
  write_output(path, bytes);
  return patch;
}

}  // namespace touchtrial::engine
