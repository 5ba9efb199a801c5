#include "bench/closed_loop/wall_sweeps.hpp"

#include "bench/closed_loop/sampled_wall.hpp"
#include "bench/gnuplot_terminal.hpp"
#include "device/model/device_model.hpp"

#include <cstdio>

#include <fmt/format.h>

namespace touchtrial::bench {
namespace {

constexpr std::array kRatesHz = {1000.0, 2000.0, 4000.0, 10'000.0};
constexpr std::array kStiffnessNPerMm = {0.1, 0.2, 0.4, 0.8, 1.6, 3.2};
constexpr std::array kWallDampingNSPerM = {-0.8, -0.4, -0.2, 0.0, 0.2, 0.4, 0.8};
constexpr std::array kDelayTicks = {0, 1, 2, 3, 5, 10};
constexpr std::array kDelayedStiffnessNPerMm = {0.1, 0.2, 0.4, 0.8};
constexpr std::array kEstimatorReadings = {2, 5, 20};
constexpr std::array kEstimatedDampingNSPerM = {0.0, 0.1, 0.2, 0.4, 0.6, 0.8, 1.2, 1.6, 2.4, 3.2};
constexpr double kUsualNPerMm = 0.4;
constexpr double kUsualPeriodS = 0.001;
constexpr double kNPerMm = 1000.0;  ///< in N/m
constexpr double kHandKg = 0.1;
/// Damping of a hand that is just enough for the wall's sampling, with room.
constexpr double kRoom = 1.2;

/// For each rate and stiffness, the bound and the results of two methods in the time domain.
std::string sweep_wall() {
  std::string data;
  std::puts("rate_hz  K N/mm  bound N s/m  by energy  by a mass at rest");
  for (std::size_t r = 0; r < kRatesHz.size(); ++r) {
    data += fmt::format("$wall{} << EOD\n", r);
    for (const double stiffness : kStiffnessNPerMm) {
      const SampledWall wall{1000.0 * stiffness, 0.0, 1.0 / kRatesHz[r]};
      const double bound = passivity_bound(wall);
      const double energy = damping_by_energy(wall);
      const double rest = damping_for_rest(wall);
      data += fmt::format("{} {} {} {}\n", stiffness, bound, energy, rest);
      fmt::print("{:7} {:7} {:12.5f} {:10.5f} {:10.5f}\n", kRatesHz[r], stiffness, bound, energy,
                 rest);
    }
    data += "EOD\n";
  }
  return data;
}

std::string draw_wall(bool png) {
  std::string script = picture_head(png, 900, 440) + sweep_wall() +
                       "set logscale xy\nset xlabel 'stiffness K of the wall, N/mm'\n"
                       "set ylabel 'physical damping needed, N s/m'\nset xrange [0.085:3.8]\n"
                       "set xtics (0.1, 0.2, 0.4, 0.8, 1.6, 3.2)\nset yrange [0.003:4]\n"
                       "set key outside right top\nplot ";
  for (std::size_t r = 0; r < kRatesHz.size(); ++r) {
    script += fmt::format(
        "{0}$wall{1} using 1:2 with lines lw 1.8 lc rgb '{2}' title '{3} kHz: K T/2', "
        "$wall{1} using 1:4 with points pt 7 ps 0.9 lc rgb '{2}' notitle, "
        "$wall{1} using 1:3 with points pt 4 ps 1.7 lw 1.4 lc rgb '{2}' notitle",
        r == 0 ? "" : ", ", r, kColours[r], kRatesHz[r] / 1000.0);
  }
  return script +
         ", NaN with points pt 7 lc rgb '#444444' title 'a mass comes to rest', "
         "NaN with points pt 4 ps 1.7 lc rgb '#444444' title 'worst motion gives no energy'\n";
}

std::string sweep_wall_damping() {
  std::string data = "$damped << EOD\n";
  std::puts("\nB N s/m  bound N s/m  by frequency  by energy   (K = 0.4 N/mm, 1 kHz)");
  for (const double damping : kWallDampingNSPerM) {
    const SampledWall wall{400.0, damping, 0.001};
    data += fmt::format("{} {} {} {}\n", damping, passivity_bound(wall), damping_by_frequency(wall),
                        damping_by_energy(wall));
    fmt::print("{:7} {:12.5f} {:13.5f} {:10.5f}\n", damping, passivity_bound(wall),
               damping_by_frequency(wall), damping_by_energy(wall));
  }
  return data + "EOD\n";
}

std::string draw_wall_damping(bool png) {
  return picture_head(png, 760, 420) + sweep_wall_damping() +
         "set xlabel 'damping B of the wall, N s/m (negative: it drives)'\n"
         "set ylabel 'physical damping needed, N s/m'\nset xrange [-0.9:0.9]\nset yrange "
         "[0:1.2]\nset key center top\n"
         "plot 0.2 + abs(x) with lines lw 1.8 lc rgb '#0072b2' title 'K T/2 + |B|', "
         "$damped using 1:3 with points pt 7 lc rgb '#d55e00' title 'frequency condition', "
         "$damped using 1:4 with points pt 4 ps 1.7 lw 1.4 lc rgb '#444444' "
         "title 'worst motion gives no energy'\n";
}

/// By delay, the bound and three ways to the damping that a wall without damping needs.
std::string sweep_delay() {
  std::string data;
  std::puts("\nK N/mm  delay ms  K (T/2 + t_d)  by frequency  by energy  by a mass   (1 kHz)");
  for (std::size_t k = 0; k < kDelayedStiffnessNPerMm.size(); ++k) {
    data += fmt::format("$delayed{} << EOD\n", k);
    for (const int ticks : kDelayTicks) {
      const SampledWall wall{.stiffness_n_per_m = kNPerMm * kDelayedStiffnessNPerMm[k],
                             .period_s = kUsualPeriodS,
                             .delay_ticks = ticks};
      const double bound = passivity_bound(wall);
      const double frequency = damping_by_frequency(wall);
      const double energy = damping_by_energy(wall);
      const double rest = damping_for_rest(wall);
      data += fmt::format("{} {} {} {}\n", ticks, bound, energy, rest);
      fmt::print("{:6} {:9} {:14.5f} {:13.5f} {:10.5f} {:10.5f}\n", kDelayedStiffnessNPerMm[k],
                 ticks, bound, frequency, energy, rest);
    }
    data += "EOD\n";
  }
  return data;
}

std::string draw_delay(bool png) {
  std::string script = picture_head(png, 900, 440) + sweep_delay() +
                       "set xlabel 'delay t_d beside the hold, ms (1 kHz)'\n"
                       "set ylabel 'physical damping needed, N s/m'\nset xrange [-0.3:10.4]\n"
                       "set yrange [0:9]\nset key outside right top\nplot ";
  for (std::size_t k = 0; k < kDelayedStiffnessNPerMm.size(); ++k) {
    script += fmt::format(
        "{0}$delayed{1} using 1:2 with lines lw 1.8 lc rgb '{2}' title 'K = {3} N/mm: "
        "K (T/2 + t_d)', $delayed{1} using 1:4 with points pt 7 ps 0.9 lc rgb '{2}' notitle, "
        "$delayed{1} using 1:3 with points pt 4 ps 1.7 lw 1.4 lc rgb '{2}' notitle",
        k == 0 ? "" : ", ", k, kColours[k], kDelayedStiffnessNPerMm[k]);
  }
  return script +
         ", NaN with points pt 7 lc rgb '#444444' title 'a mass comes to rest', "
         "NaN with points pt 4 ps 1.7 lc rgb '#444444' title 'worst motion gives no energy'\n";
}

/// By the wall's own damping, what is left to hand and device, with each estimator of velocity.
std::string sweep_estimators() {
  std::string data;
  std::puts(
      "\ndelay ms  B N s/m  needed N s/m with the velocity of 2, 5, 20 readings   "
      "(K = 0.4 N/mm, 1 kHz)");
  for (const int ticks : {0, 2}) {
    data += fmt::format("$estimated{} << EOD\n", ticks);
    for (const double damping : kEstimatedDampingNSPerM) {
      fmt::print("{:8} {:8}", ticks, damping);
      data += fmt::format("{}", damping);
      for (const int readings : kEstimatorReadings) {
        const double needed = damping_by_frequency({.stiffness_n_per_m = kNPerMm * kUsualNPerMm,
                                                    .damping_n_s_per_m = damping,
                                                    .period_s = kUsualPeriodS,
                                                    .delay_ticks = ticks,
                                                    .velocity_readings = readings});
        data += fmt::format(" {}", needed);
        fmt::print(" {:10.4f}", needed);
      }
      data += "\n";
      std::puts("");
    }
    data += "EOD\n";
  }
  return data;
}

std::string draw_estimators(bool png) {
  std::string script =
      picture_head(png, 1040, 440) + sweep_estimators() +
      "set multiplot layout 1,2\nset xlabel 'damping B of the wall, N s/m'\n"
      "set ylabel 'physical damping needed, N s/m'\nset xrange [0:3.3]\nset yrange [0:3.6]\n";
  for (const int ticks : {0, 2}) {
    script += fmt::format("set title 'delay {} ms beside the hold'\nplot ", ticks);
    for (std::size_t e = 0; e < kEstimatorReadings.size(); ++e) {
      const std::string name = kEstimatorReadings[e] == 2
                                   ? "difference of 2 readings"
                                   : fmt::format("line through {} readings", kEstimatorReadings[e]);
      script += fmt::format(
          "{}$estimated{} using 1:{} with linespoints pt 7 ps 0.6 lw 1.8 lc rgb '{}' title '{}'",
          e == 0 ? "" : ", ", ticks, e + 2, kColours[e], name);
    }
    script += "\n";
  }
  return script + "unset multiplot\n";
}

}  // namespace

std::string picture_head(bool png, int width, int height) {
  return gnuplot_terminal(png, width, height) +
         "set encoding utf8\nset border 3 lw 1.2\nset tics nomirror out scale 0.6\n"
         "set grid lc rgb '#e4e4e4' lw 1\nset key left top Left reverse samplen 2 spacing 1.25\n";
}

std::vector<WallPicture> wall_pictures(bool png) {
  return {{"passivity-stiffness", draw_wall(png)},
          {"passivity-damping", draw_wall_damping(png)},
          {"passivity-delay", draw_delay(png)},
          {"passivity-estimators", draw_estimators(png)}};
}

void print_quantised_walls() {
  std::puts(
      "\nK N/mm  D mm   K D/2 mN  by energy  by a mass   without friction: mm/s rms, mm   "
      "(0.1 kg, 1 kHz)");
  for (const double stiffness : {0.2, 0.4, 0.8}) {
    for (const double step_mm : {0.01, 0.038, 0.055}) {
      const SampledWall wall{
          .stiffness_n_per_m = kNPerMm * stiffness, .period_s = kUsualPeriodS, .step_mm = step_mm};
      const double damping = kRoom * passivity_bound(wall);
      const LimitCycle cycle = limit_cycle(wall, kHandKg, damping);
      fmt::print("{:6} {:6} {:8.2f} {:10.2f} {:10.2f} {:20.3f} {:9.4f}\n", stiffness, step_mm,
                 1000.0 * friction_bound(wall), 1000.0 * friction_by_energy(wall),
                 1000.0 * friction_for_rest(wall, kHandKg, damping), cycle.mm_s, cycle.mm);
    }
  }
}

void print_device_models() {
  std::puts(
      "\nmodel         delay ms  needs N s/m  step mm  needs mN  has mN   "
      "(a wall of 0.4 N/mm, 1 kHz)");
  for (const device::DeviceModel& model : device::shipped_device_models()) {
    const SampledWall wall{.stiffness_n_per_m = kNPerMm * kUsualNPerMm,
                           .period_s = kUsualPeriodS,
                           .delay_ticks = model.delay_ticks,
                           .step_mm = model.position_step_mm};
    fmt::print("{:13} {:8} {:12.3f} {:8} {:9.2f} {:7.0f}\n", model.name, model.delay_ticks,
               passivity_bound(wall), model.position_step_mm, 1000.0 * friction_bound(wall),
               1000.0 * model.coulomb_n);
  }
}

}  // namespace touchtrial::bench
