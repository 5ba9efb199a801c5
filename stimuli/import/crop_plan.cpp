#include "stimuli/import/crop_plan.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <utility>

namespace touchtrial::stimuli {
namespace {

/// The number of crops along one axis whose starts are at least half a side apart.
int axis_capacity(int length_px, int side_px) {
  return length_px < side_px ? 0 : 1 + (length_px - side_px) / ((side_px + 1) / 2);
}

/// The starts of `count` segments that do not overlap, at random distances.
std::vector<int> random_starts(int length_px, int side_px, int count, RandomStream& random) {
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

/// The overlap of neighbours, as a share of the side, if `count` crops are spread evenly.
double axis_overlap(int length_px, int side_px, int count) {
  if (count == 1) return 0.0;
  const double step = static_cast<double>(length_px - side_px) / (count - 1);
  return std::max(0.0, 1.0 - step / side_px);
}

struct Grid {
  int rows = 0;
  int columns = 0;
};

/// The grid with enough crops and the least overlap.
Grid least_overlapping_grid(PhotoSize photo, int side_px, int count) {
  Grid best;
  double min_overlap = 2.0;
  const int max_columns = axis_capacity(photo.width_px, side_px);
  for (int rows = 1; rows <= axis_capacity(photo.height_px, side_px); ++rows) {
    const int columns = (count + rows - 1) / rows;
    if (columns > max_columns) continue;
    const double overlap = std::max(axis_overlap(photo.height_px, side_px, rows),
                                    axis_overlap(photo.width_px, side_px, columns));
    if (overlap >= min_overlap) continue;
    min_overlap = overlap;
    best = {rows, columns};
  }
  return best;
}

/// The positions of separate crops: rows at random distances, and crops at random distances within
/// each row.
std::vector<CropPosition> separate_positions(PhotoSize photo, int side_px, RandomStream& random) {
  std::vector<CropPosition> positions;
  for (const int y : random_starts(photo.height_px, side_px, photo.height_px / side_px, random)) {
    for (const int x : random_starts(photo.width_px, side_px, photo.width_px / side_px, random)) {
      positions.push_back({y, x});
    }
  }
  return positions;
}

std::vector<CropPosition> even_positions(PhotoSize photo, int side_px, int count) {
  const Grid grid = least_overlapping_grid(photo, side_px, count);
  std::vector<CropPosition> positions;
  for (const int y : even_starts(photo.height_px, side_px, grid.rows)) {
    for (const int x : even_starts(photo.width_px, side_px, grid.columns)) {
      positions.push_back({y, x});
    }
  }
  return positions;
}

/// Assigns crops in turn to the photographs that still have room.
void assign_crops(std::vector<int>& crop_counts, std::span<const int> room, int& remaining) {
  for (bool has_progress = true; has_progress && remaining > 0;) {
    has_progress = false;
    for (std::size_t i = 0; i < crop_counts.size() && remaining > 0; ++i) {
      if (crop_counts[i] >= room[i]) continue;
      ++crop_counts[i];
      --remaining;
      has_progress = true;
    }
  }
}

}  // namespace

PhotoPart opaque_part(const GreyImage& opacity, int min_px) {
  PhotoPart best;
  std::pair<int, std::int64_t> max_value{0, 0};
  // Height of the opaque run ending in this row, by column; 0 after the last column.
  std::vector<int> heights(static_cast<std::size_t>(opacity.width()) + 1);
  for (int y = 0; y < opacity.height(); ++y) {
    std::vector<std::pair<int, int>> open_runs;  // possible starts of a part, with heights
    for (int x = 0; x <= opacity.width(); ++x) {
      int& height = heights[static_cast<std::size_t>(x)];
      height = x < opacity.width() && opacity.at(y, x) != 0 ? height + 1 : 0;
      int left = x;
      while (!open_runs.empty() && open_runs.back().second >= height) {
        const auto [run_start, run_height] = open_runs.back();
        open_runs.pop_back();
        left = run_start;
        const std::pair value(std::min({run_height, x - run_start, min_px}),
                              std::int64_t{run_height} * (x - run_start));
        if (value <= max_value) continue;
        max_value = value;
        best = {run_start, y + 1 - run_height, {run_height, x - run_start}};
      }
      open_runs.emplace_back(left, height);
    }
  }
  return best;
}

GreyImage crop_image(const GreyImage& image, const PhotoPart& part) {
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
  return axis_capacity(photo.height_px, side_px) * axis_capacity(photo.width_px, side_px);
}

std::vector<CropPosition> crop_positions(PhotoSize photo, int side_px, int count,
                                         RandomStream& random) {
  std::vector<CropPosition> positions = count <= separate_crops(photo, side_px)
                                            ? separate_positions(photo, side_px, random)
                                            : even_positions(photo, side_px, count);
  shuffle(std::span(positions), random);
  positions.resize(static_cast<std::size_t>(count));
  return positions;
}

std::vector<int> distribute_crops(std::span<const PhotoSize> photos, int side_px, int count) {
  std::vector<int> separate_room;
  std::vector<int> overlapping_room;
  for (const PhotoSize& photo : photos) {
    separate_room.push_back(separate_crops(photo, side_px));
    overlapping_room.push_back(overlapping_crops(photo, side_px));
  }
  std::vector<int> crop_counts(photos.size(), 0);
  int remaining = count;
  assign_crops(crop_counts, separate_room, remaining);
  assign_crops(crop_counts, overlapping_room, remaining);
  return remaining == 0 ? crop_counts : std::vector<int>{};
}

}  // namespace touchtrial::stimuli
