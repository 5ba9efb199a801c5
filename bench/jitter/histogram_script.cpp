#include "analysis/figures/gnuplot.hpp"
#include "bench/gnuplot_terminal.hpp"
#include "bench/jitter/results.hpp"
#include "core/errors.hpp"
#include "device/servo/servo.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <vector>

#include <fmt/format.h>

namespace touchtrial::bench::jitter {
namespace {

/// Distinct for readers with any colour vision (Okabe and Ito, 2008).
constexpr std::array<const char*, 6> kColours = {"#0072b2", "#d55e00", "#009e73",
                                                 "#cc79a7", "#e69f00", "#000000"};
constexpr int kBarsOfDecade = 10;
/// The first bar holds all shorter times: a logarithmic axis has no zero.
constexpr double kShortestUs = 0.1;
constexpr int kPanelPx = 330;
constexpr int kMarginPx = 60;

constexpr const char* kStyle = R"(set encoding utf8
set border 3 lw 1.2
set tics nomirror out scale 0.6
set grid lc rgb '#e4e4e4' lw 1
set logscale xy
set format x '%g'
set format y '%g'
set ylabel 'share of the ticks, %'
set key tmargin center horizontal Left reverse noenhanced samplen 2 width 2
set lmargin 11
set rmargin 3
)";

std::string terminal_for(const std::filesystem::path& picture, int panels) {
  const int height = panels * kPanelPx + kMarginPx;
  const bool png = picture.extension() == ".png";
  if (png || picture.extension() == ".svg") return gnuplot_terminal(png, 1000, height);
  throw UsageError("--picture " + picture.string() + ": must end in .svg or .png");
}

/// Percentage of the ticks in each bar, by the number of the bar on the logarithmic axis.
std::map<int, double> bars_of(const device::DurationHistogram& histogram) {
  std::map<int, double> bars;
  for (std::size_t i = 0; i < device::DurationHistogram::kBins; ++i) {
    const device::DurationHistogram::Bin bin = histogram.bin(i);
    if (bin.count == 0) continue;
    const double middle_us = 0.5e-3 * static_cast<double>(bin.least_ns + bin.end_ns);
    const double place = kBarsOfDecade * std::log10(std::max(middle_us, kShortestUs));
    bars[static_cast<int>(std::floor(place))] +=
        100.0 * static_cast<double>(bin.count) / static_cast<double>(histogram.count());
  }
  return bars;
}

std::string data_of(std::size_t number, const device::DurationHistogram& histogram, double floor) {
  const std::map<int, double> bars = bars_of(histogram);
  std::string data = fmt::format("$bars{} << EOD\n", number);
  if (!bars.empty()) {
    for (int bar = bars.begin()->first - 1; bar <= bars.rbegin()->first + 1; ++bar) {
      const auto found = bars.find(bar);
      data += fmt::format("{} {}\n", std::pow(10.0, (bar + 0.5) / kBarsOfDecade),
                          found == bars.end() ? floor : found->second);
    }
  }
  return data + "EOD\n";
}

std::string title_of(const Measurement& m) {
  const std::string load =
      m.conditions.load == 0 ? "no load" : fmt::format("{} threads of load", m.conditions.load);
  const std::string had =
      m.scheduling.policy == device::SchedulingPolicy::fifo ? "SCHED_FIFO" : "SCHED_OTHER";
  return had + ", " + load;
}

std::string panel(std::span<const Measurement> all, double rate_hz) {
  std::string plot;
  std::size_t curve = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (all[i].conditions.rate_hz != rate_hz) continue;
    const char* colour = kColours[curve++ % kColours.size()];
    plot += fmt::format("{}$bars{} with histeps lc rgb '{}' lw 2 title {}",
                        plot.empty() ? "plot " : ", ", i, colour,
                        analysis::gnuplot_string(title_of(all[i])));
  }
  return plot + "\n";
}

std::vector<double> rates_of(std::span<const Measurement> all) {
  std::vector<double> rates;
  for (const Measurement& m : all) {
    if (std::find(rates.begin(), rates.end(), m.conditions.rate_hz) == rates.end()) {
      rates.push_back(m.conditions.rate_hz);
    }
  }
  return rates;
}

}  // namespace

std::string histogram_script(Measured what, std::span<const Measurement> all,
                             const std::filesystem::path& picture) {
  const std::vector<double> rates = rates_of(all);
  std::string script = terminal_for(picture, static_cast<int>(rates.size())) + kStyle;
  std::uint64_t most = 1;
  double worst_us = 1.0;
  for (const Measurement& m : all) {
    most = std::max(most, m.histogram.count());
    worst_us = std::max(worst_us, m.histogram.percentile_us(1.0));
  }
  const double floor = 50.0 / static_cast<double>(most);  // half of one tick
  for (std::size_t i = 0; i < all.size(); ++i) script += data_of(i, all[i].histogram, floor);
  script += fmt::format("set xrange [{}:{}]\nset yrange [{}:200]\nset multiplot layout {}, 1\n",
                        0.8 * kShortestUs, 1.5 * worst_us, floor, rates.size());
  const std::string of =
      what == Measured::lateness ? "lateness of a tick" : "time that a tick takes";
  for (const double rate_hz : rates) {
    script += fmt::format("set xlabel '{}{}, us'\n", of,
                          what == Measured::lateness ? fmt::format(" at {} Hz", rate_hz) : "") +
              panel(all, rate_hz);
  }
  return script + "unset multiplot\n";
}

}  // namespace touchtrial::bench::jitter
