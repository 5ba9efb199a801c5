#include "stimuli/import/crop_plan.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <utility>

namespace touchtrial::stimuli {
namespace {

/// The number of crops along one axis whose starts are at least half a side apart.
int overlapping_along(int length_px, int side_px) {
  return length_px < side_px ? 0 : 1 + (length_px - side_px) / ((side_px + 1) / 2);
}

/// The starts of `count` segments that do not overlap, at random distances.
std::vector<int> loose_starts(int length_px, int side_px, int count, RandomStream& random) {
  const auto slack = static_cast<std::uint64_t>(length_px - count * side_px);
  std::vector<int> starts;
  for (int i = 0; i < count; ++i) starts.push_back(static_cast<int>(random.below(slack + 1)));
  std::ranges::sort(starts);
  for (int i = 0; i < count; ++i) starts[static_cast<std::size_t>(i)] += i * side_px;
  return starts;
}

/// Starts spread evenly from edge to edge; a single one is in the middle.
std::vector<int> even_starts(int length_px, int side_px, int count) {
  const int room = length_px - side_px;
  std::vector<int> starts;
  for (int i = 0; i < count; ++i) starts.push_back(count == 1 ? room / 2 : room * i / (count - 1));
  return starts;
}

/// The share of a crop's side that lies in its neighbour, too, if `count` crops are spread evenly.
double overlap_along(int length_px, int side_px, int count) {
  if (count == 1) return 0.0;
  const double step = static_cast<double>(length_px - side_px) / (count - 1);
  return std::max(0.0, 1.0 - step / side_px);
}

struct Grid {
  int rows = 0;
  int columns = 0;
};

/// Of the grids with enough crops, the one whose neighbours overlap least.
Grid least_overlapping_grid(PhotoSize photo, int side_px, int count) {
  Grid best;
  double least = 2.0;
  const int max_columns = overlapping_along(photo.width_px, side_px);
  for (int rows = 1; rows <= overlapping_along(photo.height_px, side_px); ++rows) {
    const int columns = (count + rows - 1) / rows;
    if (columns > max_columns) continue;
    const double overlap = std::max(overlap_along(photo.height_px, side_px, rows),
                                    overlap_along(photo.width_px, side_px, columns));
    if (overlap >= least) continue;
    least = overlap;
    best = {rows, columns};
  }
  return best;
}

/// Separate crops: rows at random distances, and in each row its own columns at random distances.
std::vector<CropPlace> separate_places(PhotoSize photo, int side_px, RandomStream& random) {
  std::vector<CropPlace> places;
  for (const int y : loose_starts(photo.height_px, side_px, photo.height_px / side_px, random)) {
    for (const int x : loose_starts(photo.width_px, side_px, photo.width_px / side_px, random)) {
      places.push_back({y, x});
    }
  }
  return places;
}

std::vector<CropPlace> even_places(PhotoSize photo, int side_px, int count) {
  const Grid grid = least_overlapping_grid(photo, side_px, count);
  std::vector<CropPlace> places;
  for (const int y : even_starts(photo.height_px, side_px, grid.rows)) {
    for (const int x : even_starts(photo.width_px, side_px, grid.columns)) {
      places.push_back({y, x});
    }
  }
  return places;
}

/// Assigns crops in turn to the photographs that still have room.
void assign_crops(std::vector<int>& shares, std::span<const int> room, int& left) {
  for (bool is_placed = true; is_placed && left > 0;) {
    is_placed = false;
    for (std::size_t i = 0; i < shares.size() && left > 0; ++i) {
      if (shares[i] >= room[i]) continue;
      ++shares[i];
      --left;
      is_placed = true;
    }
  }
}

}  // namespace

PhotoPart opaque_part(const GreyImage& opacity, int min_px) {
  PhotoPart best;
  std::pair<int, std::int64_t> most{0, 0};
  // The height of the opaque run that ends in this row, by column; 0 after the last.
  std::vector<int> heights(static_cast<std::size_t>(opacity.width()) + 1);
  for (int y = 0; y < opacity.height(); ++y) {
    std::vector<std::pair<int, int>> rising;  // possible starts of a part, with heights
    for (int x = 0; x <= opacity.width(); ++x) {
      int& height = heights[static_cast<std::size_t>(x)];
      height = x < opacity.width() && opacity.at(y, x) != 0 ? height + 1 : 0;
      int left = x;
      while (!rising.empty() && rising.back().second >= height) {
        const auto [from, high] = rising.back();
        rising.pop_back();
        left = from;
        const std::pair value(std::min({high, x - from, min_px}), std::int64_t{high} * (x - from));
        if (value <= most) continue;
        most = value;
        best = {from, y + 1 - high, {high, x - from}};
      }
      rising.emplace_back(left, height);
    }
  }
  return best;
}

GreyImage cut(const GreyImage& image, const PhotoPart& part) {
  GreyImage pixels(part.size_px.height_px, part.size_px.width_px);
  for (int y = 0; y < pixels.height(); ++y) {
    std::ranges::copy(
        image.row(part.y + y).subspan(static_cast<std::size_t>(part.x), pixels.row(y).size()),
        pixels.row(y).begin());
  }
  return pixels;
}

int separate_crops(PhotoSize photo, int side_px) {
  return (photo.height_px / side_px) * (photo.width_px / side_px);
}

int overlapping_crops(PhotoSize photo, int side_px) {
  return overlapping_along(photo.height_px, side_px) * overlapping_along(photo.width_px, side_px);
}

std::vector<CropPlace> crop_places(PhotoSize photo, int side_px, int count, RandomStream& random) {
  std::vector<CropPlace> places = count <= separate_crops(photo, side_px)
                                      ? separate_places(photo, side_px, random)
                                      : even_places(photo, side_px, count);
  shuffle(std::span(places), random);
  places.resize(static_cast<std::size_t>(count));
  return places;
}

std::vector<int> crop_shares(std::span<const PhotoSize> photos, int side_px, int count) {
  std::vector<int> separate;
  std::vector<int> overlapping;
  for (const PhotoSize& photo : photos) {
    separate.push_back(separate_crops(photo, side_px));
    overlapping.push_back(overlapping_crops(photo, side_px));
  }
  std::vector<int> shares(photos.size(), 0);
  int left = count;
  assign_crops(shares, separate, left);
  assign_crops(shares, overlapping, left);
  return left == 0 ? shares : std::vector<int>{};
}

}  // namespace touchtrial::stimuli
