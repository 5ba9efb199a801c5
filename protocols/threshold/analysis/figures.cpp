#include "protocols/threshold/analysis/figures.hpp"

#include "analysis/report/figures/study_figures.hpp"
#include "analysis/report/figures/style.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include <fmt/format.h>

namespace touchtrial::analysis::threshold {
namespace {

/// "-21.3 dB (-23.0 to -19.6 dB)"
std::string decibels_with_interval(const CensoredMean& mean) {
  if (!mean.mean) return "no mean";
  if (!mean.interval) return fmt::format("{:.1f} dB", *mean.mean);
  return fmt::format("{:.1f} dB ({:.1f} to {:.1f} dB)", *mean.mean, mean.interval->low,
                     mean.interval->high);
}

/// ", 3 above the levels, 1 below"; empty if everybody's threshold is known.
std::string beyond_in_words(const StandardReport& one) {
  std::string text;
  const auto add = [&](procedures::Censored censored, const char* where) {
    const int n = one.number_of(censored);
    if (n > 0) text += fmt::format(", {} {}", n, where);
  };
  add(procedures::Censored::above, "above the levels");
  add(procedures::Censored::below, "below the levels");
  add(procedures::Censored::undetermined, "not determined");
  return text;
}

std::string alt_of_thresholds(const ThresholdReport& report) {
  std::string alt = "Each participant's threshold as a dot, the mean and its 95 % interval.";
  for (const StandardReport& one : report.standards) {
    if (one.mean.participants == 0) continue;
    alt += fmt::format(" {}: {} participants{}, {}.", one.words, one.mean.participants,
                       beyond_in_words(one), decibels_with_interval(one.mean));
  }
  return alt;
}

/// Of an axis of levels, beyond its ends.
double room_at_ends(const ThresholdReport& report) {
  const std::vector<double>& levels = report.options().track.levels;
  return std::max(0.05 * (levels.back() - levels.front()), 1.0);
}

/// \param means  that must be seen too, in their second column
std::string level_axis(const ThresholdReport& report, const Rows& means = {}) {
  const std::vector<double>& levels = report.options().track.levels;
  double low = levels.front();
  double high = levels.back();
  for (const std::vector<double>& row : means) {
    low = std::min(low, row[1]);
    high = std::max(high, row[1]);
  }
  const double room = room_at_ends(report);
  return fmt::format("[{:.6g}:{:.6g}]", low - room, high + room);
}

std::string unit_label(const ThresholdReport& report) {
  return report.options().task == study::threshold::Task::detection
             ? "level, dB re the pack''s gain"
             : "level, 20 log10 of the difference";
}

/// "bark, -12 dB" for "bark, standard -12 dB"
std::string short_name(const StandardReport& standard) {
  constexpr std::string_view kWord = "standard ";
  std::string name = standard.words;
  const std::size_t at = name.find(kWord);
  if (at != std::string::npos) name.erase(at, kWord.size());
  return name;
}

struct ThresholdRows {
  Rows dots;
  Rows above;  ///< people, beyond the levels
  Rows below;
  Rows means;  ///< place, mean, low, high
};

ThresholdRows rows_of_thresholds(const ThresholdReport& report) {
  ThresholdRows rows;
  for (std::size_t i = 0; i < report.standards.size(); ++i) {
    const StandardReport& one = report.standards[i];
    if (one.levels.empty()) continue;
    const auto x = static_cast<double>(i + 1);
    const double room = room_at_ends(report);
    std::vector<double> sorted;
    for (const Bounds& bounds : bounds_of(one.thresholds)) {
      if (bounds.exact()) sorted.push_back(bounds.low);
    }
    std::ranges::sort(sorted);
    add_dots(rows.dots, x - 0.12, 0.3, sorted);
    const auto add_beyond = [&](Rows& to, procedures::Censored side, double level) {
      add_dots(to, x - 0.12, 0.3,
               std::vector(static_cast<std::size_t>(one.number_of(side)), level));
    };
    add_beyond(rows.above, procedures::Censored::above, one.levels.back() + 0.5 * room);
    add_beyond(rows.below, procedures::Censored::below, one.levels.front() - 0.5 * room);
    if (one.mean.mean) add_bar(rows.means, x + 0.2, *one.mean.mean, one.mean.interval);
  }
  return rows;
}

constexpr int kMarkAbove = 8;  ///< triangles, in gnuplot's numbers
constexpr int kMarkBelow = 10;

std::string data_of_thresholds(const ThresholdRows& rows) {
  std::string data;
  const auto add = [&data](const char* name, const Rows& of) {
    if (!of.empty()) data += data_block(name, of);
  };
  add("dots", rows.dots);
  add("above", rows.above);
  add("below", rows.below);
  add("means", rows.means);
  return data;
}

std::string plot_of_thresholds(const ThresholdRows& rows) {
  std::string plot;
  const auto add = [&plot](const Rows& of, const std::string& how) {
    if (of.empty()) return;
    plot += (plot.empty() ? "plot " : ", ") + how + " notitle";
  };
  const auto points = [](const char* name, int mark, std::size_t series) {
    return fmt::format("${} using 1:2 with points pt {} ps 0.5 lc rgb '{}'", name, mark,
                       series_colour(series));
  };
  add(rows.dots, points("dots", series_mark(0), 0));
  add(rows.above, points("above", kMarkAbove, 1));
  add(rows.below, points("below", kMarkBelow, 1));
  add(rows.means,
      fmt::format("$means using 1:2:3:4 with yerrorbars pt 13 ps 1 lw 1.8 lc rgb '{}'", kInk));
  return plot + "\n";
}

/// Answers at each level of one standard, in all tracks.
std::map<std::size_t, Proportion> pooled_answers(const ThresholdReport& report,
                                                 std::size_t standard) {
  std::map<std::size_t, Proportion> answers;
  const std::size_t top = report.standards[standard].levels.size() - 1;
  for (const TrackReport& track : report.tracks) {
    if (track.standard != standard) continue;
    for (const procedures::TrackTrial& trial : track.trials) {
      answers[trial.level].add(trial.correct);
    }
    if (track.catches.n > 0) answers[top] += track.catches;
  }
  return answers;
}

/// Level, per cent right, and the size of the mark, whose area grows with the number of trials.
Rows rows_of_answers(const ThresholdReport& report, std::size_t standard) {
  const std::map<std::size_t, Proportion> answers = pooled_answers(report, standard);
  int most = 1;
  for (const auto& [level, of] : answers) most = std::max(most, of.n);
  Rows rows;
  for (const auto& [level, of] : answers) {
    const double size = 0.25 + 1.05 * std::sqrt(static_cast<double>(of.n) / most);
    rows.push_back({report.options().track.levels[level], 100.0 * *of.share(), size});
  }
  return rows;
}

/// The mean of the estimated functions at evenly spaced levels, of all tracks.
Rows rows_of_curve(const ThresholdReport& report, std::size_t standard) {
  constexpr int kPoints = 120;
  const std::vector<double>& levels = report.options().track.levels;
  std::vector<const procedures::Observer*> observers;
  for (const TrackReport& track : report.tracks) {
    if (track.standard == standard && track.estimate) {
      observers.push_back(&track.estimate->observer);
    }
  }
  Rows rows;
  if (observers.empty()) return rows;
  for (int i = 0; i <= kPoints; ++i) {
    const double level = std::lerp(levels.front(), levels.back(), static_cast<double>(i) / kPoints);
    double sum = 0.0;
    for (const procedures::Observer* observer : observers) {
      sum += procedures::shares_at(*observer, level).correct;
    }
    rows.push_back({level, 100.0 * sum / static_cast<double>(observers.size())});
  }
  return rows;
}

std::string plot_of_function(std::size_t panel, bool has_curve) {
  std::string plot =
      fmt::format("plot $answers{} using 1:2:3 with points pt 7 ps variable lc rgb '{}' notitle",
                  panel, series_colour(0));
  if (has_curve) {
    plot += fmt::format(", $curve{} using 1:2 with lines lw 1.8 lc rgb '{}' notitle", panel, kInk);
  }
  return plot + "\n";
}

Legend legend_of_functions(const Sheet& sheet, const ThresholdReport& report) {
  return Legend(sheet, 1.5,
                std::vector<LegendEntry>{
                    mark_entry(7, series_colour(0), "all answers at a level; area by number"),
                    {LegendEntry::Kind::line, std::string(kInk), 7, "mean of estimated functions"},
                    {LegendEntry::Kind::dashes, std::string(kInk), 7,
                     fmt::format("threshold: {:.1f} %", 100.0 * *report.criterion)}});
}

/// The most tracks that are drawn.
constexpr std::size_t kMaxTrackPanels = 12;

/// Trial and level of the right, or of the wrong answers.
Rows rows_of_track(const ThresholdReport& report, const TrackReport& track, bool correct) {
  Rows rows;
  for (std::size_t i = 0; i < track.trials.size(); ++i) {
    if (track.trials[i].correct != correct) continue;
    rows.push_back(
        {static_cast<double>(i + 1), report.options().track.levels[track.trials[i].level]});
  }
  return rows;
}

std::string plot_of_track(std::size_t panel, const Rows& right, const Rows& wrong) {
  std::string plot;
  const auto add = [&](const Rows& rows, const char* name, const char* look,
                       std::string_view colour) {
    if (rows.empty()) return;
    plot += fmt::format("{}${}{} using 1:2 with points {} lc rgb '{}' notitle",
                        plot.empty() ? "plot " : ", ", name, panel, look, colour);
  };
  add(right, "right", "pt 7 ps 0.35", series_colour(0));
  add(wrong, "wrong", "pt 2 ps 0.5 lw 1.4", series_colour(1));
  return plot + "\n";
}

std::string threshold_line(const TrackReport& track) {
  return track.threshold() ? dashed_line(*track.threshold()) : "";
}

Legend legend_of_tracks(const Sheet& sheet) {
  return Legend(
      sheet, 1.5,
      std::vector<LegendEntry>{mark_entry(7, series_colour(0), "right"),
                               mark_entry(2, series_colour(1), "wrong"),
                               {LegendEntry::Kind::dashes, std::string(kInk), 7, "threshold"}});
}

std::string panel_of_track(const ThresholdReport& report, const Panels& panels, std::size_t panel) {
  const TrackReport& track = report.tracks[panel];
  const Rows right = rows_of_track(report, track, true);
  const Rows wrong = rows_of_track(report, track, false);
  std::string script;
  if (!right.empty()) script += data_block(fmt::format("right{}", panel), right);
  if (!wrong.empty()) script += data_block(fmt::format("wrong{}", panel), wrong);
  return script +
         panels.begin(panel, fmt::format("{}, {}", track.participant,
                                         short_name(report.standards[track.standard]))) +
         fmt::format(
             "set xrange [0:{}]\nset yrange {}\nset xlabel 'trial' offset 0, 0.4\n"
             "set ylabel 'level, dB'\n",
             track.trials.size() + 1, level_axis(report)) +
         threshold_line(track) + (panel == 0 ? legend_of_tracks(panels.sheet()).script() : "") +
         plot_of_track(panel, right, wrong) + "unset label\nunset arrow\nunset object\n";
}

std::string alt_of_track(const ThresholdReport& report, const TrackReport& track) {
  const std::string begin =
      fmt::format(" {}, {}: {} of {} right,", track.participant,
                  report.standards[track.standard].words, track.answers.correct, track.answers.n);
  if (!track.threshold()) return begin + " no threshold.";
  return begin + fmt::format(" threshold {:.1f} dB.", *track.threshold());
}

/// Level, d', low and high, of one standard.
Rows rows_of_d_prime(const ThresholdReport& report, std::size_t standard) {
  Rows rows;
  for (const SameDifferentGroup& one : report.same_different_groups) {
    if (one.standard != standard || !one.differencing.d_prime) continue;
    add_bar(rows, one.level, *one.differencing.d_prime, one.differencing.interval);
  }
  return rows;
}

}  // namespace

std::optional<Figure> thresholds_figure(const ThresholdReport& report) {
  const ThresholdRows rows = rows_of_thresholds(report);
  if (rows.dots.empty() && rows.above.empty() && rows.below.empty()) return {};
  std::vector<std::string> names;
  for (const StandardReport& one : report.standards) names.push_back(short_name(one));
  Sheet sheet{16.0, 8.0, report.simulated};
  Margins margins;
  const NamesBelow below(names, sheet.width_cm - margins.left_cm - margins.right_cm);
  margins.bottom_cm = below.room_cm() + 0.3;
  sheet.height_cm = 6.5 + margins.bottom_cm;
  const Legend legend(
      sheet, margins.left_cm,
      std::vector<LegendEntry>{mark_entry(series_mark(0), series_colour(0), "participants"),
                               mark_entry(kMarkAbove, series_colour(1), "beyond the levels"),
                               mark_entry(13, kInk, "mean, with 95 % interval")});
  margins.top_cm = legend.room_cm() + 0.2;
  Figure figure = figure_on(sheet, "thresholds", alt_of_thresholds(report), "thresholds");
  figure.caption = stamped(
      report.simulated,
      "participants' thresholds, triangles for those beyond the levels, and the mean of all with "
      "its 95 % interval.");
  figure.script = data_of_thresholds(rows) + sheet_head(sheet) + panel_at(sheet, margins) +
                  below.script() +
                  fmt::format("set yrange {}\nset ylabel '{}' noenhanced\n",
                              level_axis(report, rows.means), unit_label(report)) +
                  legend.script() + plot_of_thresholds(rows);
  return figure;
}

std::optional<Figure> functions_figure(const ThresholdReport& report) {
  if (!report.has_thresholds() || report.tracks.empty()) return {};
  const std::size_t count = report.standards.size();
  const Panels panels(count, 2, 6.4, {1.5, 0.4, 0.6, 1.25}, report.simulated);
  Figure figure = figure_on(panels.sheet(), "functions",
                            "Right answers by level, all participants, and the mean of the "
                            "functions that were estimated.",
                            "thresholds");
  const std::size_t said = figure.alt.size();
  figure.script = sheet_head(panels.sheet()) + "set multiplot\n";
  for (std::size_t i = 0; i < count; ++i) {
    const Rows answers = rows_of_answers(report, i);
    const Rows curve = rows_of_curve(report, i);
    if (answers.empty()) continue;
    const bool is_first = figure.alt.size() == said;
    figure.script += data_block(fmt::format("answers{}", i), answers) +
                     (curve.empty() ? "" : data_block(fmt::format("curve{}", i), curve)) +
                     panels.begin(i, report.standards[i].words) + accuracy_axis("right, %") +
                     fmt::format("set xlabel '{}' offset 0, 0.4 noenhanced\nset xrange {}\n",
                                 unit_label(report), level_axis(report)) +
                     dashed_line(100.0 * *report.criterion) +
                     (is_first ? legend_of_functions(panels.sheet(), report).script() : "") +
                     plot_of_function(i, !curve.empty()) +
                     "unset label\nunset arrow\nunset object\n";
    figure.alt += fmt::format(" {}: {:.0f} % right at {:.1f} dB, {:.0f} % at {:.1f} dB.",
                              report.standards[i].words, answers.front()[1], answers.front()[0],
                              answers.back()[1], answers.back()[0]);
  }
  figure.script += "unset multiplot\n";
  figure.caption = stamped(report.simulated,
                           "right answers by level, all participants' trials pooled, catch trials "
                           "among them, and the mean of the functions estimated from their tracks. "
                           "An adaptive procedure puts "
                           "its trials near each participant's threshold, so pooled points lie "
                           "flatter than the function of one participant.");
  return figure;
}

std::optional<Figure> tracks_figure(const ThresholdReport& report) {
  if (!report.has_thresholds() || report.tracks.empty()) return {};
  const std::size_t count = std::min(report.tracks.size(), kMaxTrackPanels);
  const Panels panels(count, 3, 4.6, {1.4, 0.3, 0.6, 1.1}, report.simulated);
  Figure figure = figure_on(panels.sheet(), "tracks", "Levels by trial, one panel a track.",
                            "tracks-of-participants");
  figure.script = sheet_head(panels.sheet()) + "set multiplot\n";
  for (std::size_t i = 0; i < count; ++i) {
    figure.script += panel_of_track(report, panels, i);
    figure.alt += alt_of_track(report, report.tracks[i]);
  }
  figure.script += "unset multiplot\n";
  figure.caption = stamped(
      report.simulated,
      "the levels that the procedure chose by trial; dots are right answers, crosses wrong ones, "
      "and the dashed line is the threshold, if there is one." +
          (count < report.tracks.size()
               ? fmt::format(" The first {} of {} tracks.", count, report.tracks.size())
               : std::string()));
  return figure;
}

std::optional<Figure> d_prime_figure(const ThresholdReport& report) {
  if (report.same_different_groups.empty()) return {};
  const std::size_t count = report.standards.size();
  const Panels panels(count, 2, 6.4, {1.5, 0.4, 0.6, 1.25}, report.simulated);
  Figure figure =
      figure_on(panels.sheet(), "d-prime-by-level",
                "d' of same or different by level, by differencing.", "same-or-different");
  figure.script = sheet_head(panels.sheet()) + "set multiplot\n";
  for (std::size_t i = 0; i < count; ++i) {
    const Rows rows = rows_of_d_prime(report, i);
    if (rows.empty()) continue;
    figure.script += data_block(fmt::format("means{}", i), rows) +
                     panels.begin(i, report.standards[i].words) +
                     fmt::format(
                         "set xlabel '{}' offset 0, 0.4 noenhanced\nset xrange {}\n"
                         "set yrange [*<0:*]\nset ylabel 'd''' noenhanced\n",
                         unit_label(report), level_axis(report)) +
                     fmt::format(
                         "plot $means{} using 1:2:3:4 with yerrorbars pt {} ps 0.7 lw 1.5 "
                         "lc rgb '{}' notitle\nunset label\n",
                         i, series_mark(0), series_colour(0));
    for (const std::vector<double>& row : rows) {
      figure.alt +=
          fmt::format(" {}, {:.1f} dB: {:.2f}.", report.standards[i].words, row[0], row[1]);
    }
  }
  figure.script += "unset multiplot\n";
  figure.caption = stamped(report.simulated,
                           "d' of same or different by level, by differencing: all participants' "
                           "answers pooled, with 95 % bootstrap intervals over participants.");
  return figure;
}

std::vector<Figure> report_figures(const ThresholdReport& report, const std::string& stamp) {
  std::vector<Figure> figures;
  const auto add = [&figures](std::optional<Figure> figure) {
    if (figure) figures.push_back(*std::move(figure));
  };
  add(flow_figure(report));
  add(thresholds_figure(report));
  add(functions_figure(report));
  add(d_prime_figure(report));
  add(tracks_figure(report));
  add(servo_figure(report, "analysis"));
  stamp_figures(stamp, figures);
  return figures;
}

}  // namespace touchtrial::analysis::threshold
