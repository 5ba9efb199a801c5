#include "engine/metrics/glcm.hpp"

#include "engine/kernels/strips.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <mutex>
#include <stdexcept>
#include <string>
#include <vector>

namespace touchtrial::engine {
namespace {

constexpr int kGreyLevels = 256;

/// Counts of one pair of levels, for each of kGlcmOffsets.
using GlcmCell = std::array<std::uint32_t, 4>;

/// Counts of each ordered pair (level of a pixel, level of its neighbour). The four directions of a
/// pair are stored together, so that neighbouring pixels use the same cache lines.
class GlcmCounts {
 public:
  explicit GlcmCounts(const GreyImage& image) : GlcmCounts() {
    if (static_cast<std::int64_t>(image.size()) < kMinParallelPixels) {
      count(image, {0, image.height()});
      return;
    }
    std::mutex mutex;
    for_each_strip(image.height(), image.width(), [&](Rows strip) {
      GlcmCounts part;
      part.count(image, strip);
      const std::lock_guard lock(mutex);
      add(part);
    });
  }

  [[nodiscard]] const GlcmCell& at(int level, int neighbour) const noexcept {
    return cells_[static_cast<std::size_t>(level * kGreyLevels + neighbour)];
  }

 private:
  GlcmCounts() : cells_(static_cast<std::size_t>(kGreyLevels) * kGreyLevels) {}

  void count(const GreyImage& image, Rows strip) {
    if (strip.first == 0) count_first_row(image);
    for (int y = std::max(strip.first, 1); y < strip.last; ++y) {
      count_row(image.row(y).data(), image.row(y - 1).data(), image.row(y).size());
    }
  }

  void add(const GlcmCounts& part) {
    for (std::size_t i = 0; i < cells_.size(); ++i) {
      for (std::size_t d = 0; d < cells_[i].size(); ++d) cells_[i][d] += part.cells_[i][d];
    }
  }

  /// Indices into a cell, as in kGlcmOffsets.
  enum Direction : std::size_t { kRight, kRightUp, kUp, kLeftUp };

  void count_first_row(const GreyImage& image) {
    const auto row = image.row(0);
    for (std::size_t x = 0; x + 1 < row.size(); ++x) {
      ++cells_[row[x] * std::size_t{kGreyLevels} + row[x + 1]][kRight];
    }
  }

  void count_row(const std::uint8_t* row, const std::uint8_t* row_above, std::size_t width) {
    const auto cells_of = [this, row](std::size_t x) {
      return cells_.data() + row[x] * std::size_t{kGreyLevels};
    };
    ++cells_of(0)[row_above[0]][kUp];
    ++cells_of(0)[row[1]][kRight];
    ++cells_of(0)[row_above[1]][kRightUp];
    for (std::size_t x = 1; x + 1 < width; ++x) {
      GlcmCell* const cells = cells_of(x);
      ++cells[row[x + 1]][kRight];
      ++cells[row_above[x + 1]][kRightUp];
      ++cells[row_above[x]][kUp];
      ++cells[row_above[x - 1]][kLeftUp];
    }
    const std::size_t last = width - 1;
    ++cells_of(last)[row_above[last]][kUp];
    ++cells_of(last)[row_above[last - 1]][kLeftUp];
  }

  std::vector<GlcmCell> cells_;
};

/// n ln n, from a table for small n.
class NLogN {
 public:
  NLogN() {
    for (std::size_t n = 1; n < kTabulated; ++n) table_[n] = compute(n);
  }
  [[nodiscard]] double operator()(std::uint64_t n) const {
    return n < kTabulated ? table_[n] : compute(n);
  }

 private:
  static constexpr std::size_t kTabulated = 2048;
  static double compute(std::uint64_t n) {
    const auto real = static_cast<double>(n);
    return real * std::log(real);
  }
  std::array<double, kTabulated> table_{};
};

const NLogN& n_log_n_table() {
  static const NLogN table;
  return table;
}

/// Sums over the symmetric matrix of one direction, from which the statistics are computed. Each
/// unordered pair of levels counts once.
struct Sums {
  std::array<std::uint64_t, kGreyLevels> marginal{};  ///< row sums of the symmetric matrix
  std::uint64_t squares = 0;           ///< of the unordered counts of different levels
  std::uint64_t diagonal_squares = 0;  ///< of the unordered counts of equal levels
  std::uint64_t distance = 0;          ///< (i - j)^2 times the unordered count
  double n_log_n = 0.0;                ///< over all entries of the symmetric matrix
};

/// Adds a pair of different levels that occurs `count` times.
void add_pair(Sums& sums, int i, int j, std::uint64_t count, const NLogN& n_log_n) {
  const auto squared_difference = static_cast<std::uint64_t>((i - j) * (i - j));
  sums.marginal[static_cast<std::size_t>(i)] += count;
  sums.marginal[static_cast<std::size_t>(j)] += count;
  sums.squares += count * count;
  sums.distance += squared_difference * count;
  sums.n_log_n += 2 * n_log_n(count);
}

/// Adds a pair of equal levels. Its entry of the symmetric matrix counts every pair twice.
void add_diagonal(Sums& sums, int i, std::uint64_t count, const NLogN& n_log_n) {
  sums.marginal[static_cast<std::size_t>(i)] += 2 * count;
  sums.diagonal_squares += count * count;
  sums.n_log_n += n_log_n(2 * count);
}

bool are_empty(const GlcmCell& a, const GlcmCell& b) {
  std::uint32_t bits = 0;
  for (std::size_t d = 0; d < a.size(); ++d) bits |= a[d] | b[d];
  return bits == 0;
}

std::vector<Sums> sums_of(const GlcmCounts& counts) {
  const NLogN& n_log_n = n_log_n_table();
  std::vector<Sums> sums(kGlcmOffsets.size());
  for (int i = 0; i < kGreyLevels; ++i) {
    for (std::size_t d = 0; d < sums.size(); ++d) {
      add_diagonal(sums[d], i, counts.at(i, i)[d], n_log_n);
    }
    for (int j = i + 1; j < kGreyLevels; ++j) {
      const GlcmCell& forward = counts.at(i, j);
      const GlcmCell& backward = counts.at(j, i);
      if (are_empty(forward, backward)) continue;
      for (std::size_t d = 0; d < sums.size(); ++d) {
        add_pair(sums[d], i, j, std::uint64_t{forward[d]} + backward[d], n_log_n);
      }
    }
  }
  return sums;
}

/// The variance of either level of a pair.
double variance_of(const std::array<std::uint64_t, kGreyLevels>& marginal, double total) {
  double mean = 0.0;
  for (std::size_t i = 0; i < marginal.size(); ++i) {
    mean += static_cast<double>(i * marginal[i]) / total;
  }
  double variance = 0.0;
  for (std::size_t i = 0; i < marginal.size(); ++i) {
    const double distance = static_cast<double>(i) - mean;
    variance += distance * distance * (static_cast<double>(marginal[i]) / total);
  }
  return variance;
}

/// Uses contrast = 2 variance - 2 covariance, because both levels of a pair have the same variance.
double correlation_of(double contrast, const Sums& sums, double total) {
  const auto levels = std::count_if(sums.marginal.begin(), sums.marginal.end(),
                                    [](std::uint64_t count) { return count != 0; });
  if (levels == 1) return 1.0;
  return std::max(-1.0, 1.0 - contrast / (2 * variance_of(sums.marginal, total)));
}

GlcmStatistics statistics_of(const Sums& sums, std::uint64_t pairs) {
  const auto n = static_cast<double>(pairs);
  GlcmStatistics result{};
  result.angular_second_moment =
      (static_cast<double>(sums.squares) / 2 + static_cast<double>(sums.diagonal_squares)) /
      (n * n);
  result.energy = std::sqrt(result.angular_second_moment);
  result.entropy = (n_log_n_table()(2 * pairs) - sums.n_log_n) / (2 * n);
  result.contrast = static_cast<double>(sums.distance) / n;
  result.correlation = correlation_of(result.contrast, sums, 2 * n);
  return result;
}

std::uint64_t pairs_of(const GreyImage& image, const GlcmOffset& offset) {
  return static_cast<std::uint64_t>(image.height() - std::abs(offset.dy)) *
         static_cast<std::uint64_t>(image.width() - std::abs(offset.dx));
}

void check(const GreyImage& image) {
  if (image.height() < 2 || image.width() < 2) {
    throw std::invalid_argument("glcm_statistics: the image is " + std::to_string(image.height()) +
                                " x " + std::to_string(image.width()) +
                                " pixels, and both sides must be at least 2");
  }
  if (image.size() > std::numeric_limits<std::uint32_t>::max()) {
    throw std::invalid_argument("glcm_statistics: the image has 2^32 pixels or more");
  }
}

}  // namespace

GlcmTable glcm_statistics(const GreyImage& image) {
  check(image);
  const std::vector<Sums> sums = sums_of(GlcmCounts(image));
  GlcmTable table{};
  for (std::size_t d = 0; d < table.size(); ++d) {
    table[d] = statistics_of(sums[d], pairs_of(image, kGlcmOffsets[d]));
  }
  return table;
}

}  // namespace touchtrial::engine
