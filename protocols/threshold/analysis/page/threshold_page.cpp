#include "core/text.hpp"
#include "protocols/threshold/analysis/page/sections.hpp"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include <fmt/format.h>

namespace touchtrial::analysis::threshold {
namespace {

using std::string_view;

/// The id of a picture and of its section. The flow of participants is for papers: the page shows
/// it as text.
constexpr std::array<std::pair<string_view, string_view>, 5> kSectionOfPicture{
    {{"thresholds", "thresholds"},
     {"functions", "thresholds"},
     {"d-prime", "same-or-different"},
     {"tracks", "tracks-of-participants"},
     {"servo", "analysis"}}};
constexpr string_view kFlowPicture = "participant-flow";

string_view section_of_picture(const Picture& picture) {
  for (const auto& [beginning, section] : kSectionOfPicture) {
    if (picture.id.starts_with(beginning)) return section;
  }
  return "analysis";
}

/// Each stands before the section's first table, so pictures keep their order.
void place_picture(const Picture& picture, std::vector<Section>& sections) {
  if (picture.id == kFlowPicture) return;
  const string_view wanted = section_of_picture(picture);
  for (Section& section : sections) {
    if (section.id != wanted) continue;
    const auto table = std::ranges::find_if(
        section.blocks, [](const Block& block) { return std::holds_alternative<Table>(block); });
    section.blocks.insert(table, picture);
    return;
  }
}

std::string procedure_words(const ThresholdReport& report) {
  const study::threshold::ThresholdOptions& options = report.options();
  std::string text = fmt::format("Procedure: {}, {} a track.", options.track.procedure,
                                 counted(options.track.trials, "trial"));
  if (report.without_answer > 0) {
    text += fmt::format(" {} without an answer belong to no track.",
                        counted(report.without_answer, "trial"));
  }
  if (options.rove_db > 0.0) {
    text += fmt::format(" Gains were roved over {} dB.", options.rove_db);
  }
  return text;
}

std::string estimate_words(const ThresholdReport& report) {
  if (!report.has_thresholds()) {
    return "The question has no fixed guess rate, so there are d' by level and no thresholds.";
  }
  if (report.by_posterior) {
    return "Quoted are posterior means with credible intervals. In simulations with known "
           "observers they are nearly without bias after 30 adaptive trials and their intervals "
           "cover at least what they state, while those of maximum likelihood cover less in short "
           "adaptive tracks (procedures-recovery.md). Slopes fitted to adaptive tracks are too "
           "steep.";
  }
  return "Quoted are maximum-likelihood fits with profile intervals, which with constant stimuli "
         "cover what they state (procedures-recovery.md). Goodness of fit is by simulation.";
}

}  // namespace

Section methods_section(const ThresholdReport& report) {
  Section section{"analysis", "Analysis", {}, true};
  section.blocks.emplace_back(Cited{procedure_words(report)});
  section.blocks.emplace_back(Cited{estimate_words(report)});
  section.blocks.emplace_back(Cited{
      "A track that reaches a bound of the levels, or whose posterior gathers at the end of its "
      "grid, is censored: it says on which side the threshold lies and enters no mean."});
  return section;
}

Document threshold_document(const ThresholdReport& report, const Provenance& provenance,
                            const Pictures& pictures) {
  const bool missing = std::ranges::any_of(pictures, &std::string::empty, &Picture::svg);
  Section result{"result", "Result", {}};
  add_headline(report, result);
  std::vector<Section> sections = {thresholds_section(report), same_different_section(report),
                                   control_section(report),    tracks_section(report),
                                   habits_section(report),     methods_section(report)};
  for (const Picture& picture : pictures) place_picture(picture, sections);
  return framed_document(report, std::move(result), std::move(sections), provenance, missing);
}

}  // namespace touchtrial::analysis::threshold
