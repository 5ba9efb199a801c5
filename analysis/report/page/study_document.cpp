#include "analysis/report/page/study_document.hpp"

#include "analysis/report/page/frame_sections.hpp"
#include "analysis/report/page/wording.hpp"
#include "analysis/report/text_figures.hpp"
#include "core/text.hpp"
#include "core/version.hpp"
#include "study/deviation_codes.hpp"

#include <algorithm>
#include <array>
#include <iterator>
#include <string_view>

#include <fmt/format.h>

namespace touchtrial::analysis {
namespace {

std::string state_words(const record::StudyState& state) {
  if (state.question) {
    return std::string(state.closed ? "closed" : "collecting") +
           "; blind except for the registered question (" + state.unblinding_reason + ")";
  }
  if (!state.unblinded) return state.closed ? "closed, still blind" : "collecting, blind";
  const std::string reason =
      state.unblinding_reason.empty() ? "" : " (" + state.unblinding_reason + ")";
  return (state.closed ? "closed and unblinded" : "open; an interim look") + reason;
}

std::string joined(const std::string& first, const std::string& second) {
  return first + (first.empty() || second.empty() ? "" : ", ") + second;
}

bool is_interim(const Provenance& provenance) {
  const record::StudyState& state = provenance.state;
  return (state.unblinded && !state.closed) || state.question;
}

template <typename Report>
std::vector<std::string> banners_of(const Report& report, const Provenance& provenance) {
  std::vector<std::string> banners;
  if (report.simulated) {
    const std::string device = simulated_on(simulated_devices(report.collection));
    if (!device.empty()) banners.push_back(device);
    banners.emplace_back(
        "SIMULATED: these numbers come from simulated participants. They describe a model of a "
        "hand and of the sense of touch, not people.");
  }
  if (report.pilot) {
    banners.emplace_back("PILOT: do not pool with the study's data or report as its result.");
  }
  if (provenance.unverified) banners.push_back(unverified_banner());
  if (provenance.is_incomplete) banners.push_back(provenance.head_summary);
  return banners;
}

void add_interim_banner(const Provenance& provenance, std::vector<std::string>& banners) {
  if (provenance.state.question) {
    banners.emplace_back(
        "INTERIM LOOK at the registered question: only its answer is shown, and only it may decide "
        "whether collection ends here. Everything else stays blind until the study is closed.");
  } else if (is_interim(provenance)) {
    banners.emplace_back(
        "INTERIM LOOK: the study is still open. These results must not decide when it ends.");
  }
}

/// A document without sections.
template <typename Report>
Document empty_document(const char* title, const Report& report, const Provenance& provenance) {
  Document document;
  document.title = title + report.study;
  document.stamp =
      joined(report.simulated ? "SIMULATED" : "", further_stamp(report.pilot, provenance));
  document.banners = banners_of(report, provenance);
  document.header.entries = {{"protocol", report.protocol},
                             {"participants", std::to_string(report.participants)},
                             {"trials", std::to_string(report.trials)}};
  document.colophon =
      fmt::format("{}touchtrial {}, {}, event {} of the file's chain, {}",
                  simulated_line(report.simulated), provenance.program_version, provenance.database,
                  provenance.head.length, to_hex(provenance.head.hash));
  return document;
}

/// Adds the state of the study and the evidence for the report.
void add_evidence(const Provenance& provenance, Definitions& header) {
  auto& entries = header.entries;
  entries.insert(
      entries.end(),
      {{"state", state_words(provenance.state)},
       {"database", provenance.database},
       {"seal of the study", provenance.seal},
       {"head of the file's chain",
        fmt::format("{} (event {})", to_hex(provenance.head.hash), provenance.head.length)},
       {"program", "touchtrial " + provenance.program_version}});
  if (!provenance.head_summary.empty()) {
    entries.emplace_back("head check", provenance.head_summary);
  }
  if (!provenance.texts.empty()) entries.emplace_back("participants' texts", provenance.texts);
}

/// Inserts a picture below the sentences of its section or subheading.
/// \return whether the picture belongs to this section
bool insert_picture(const Picture& picture, Section& section) {
  std::vector<Block>& blocks = section.is_folded() ? section.folded_blocks : section.blocks;
  auto position = blocks.begin();
  if (section.id != picture.section) {
    position = std::ranges::find_if(blocks, [&](const Block& block) {
      const auto* heading = std::get_if<Subheading>(&block);
      return heading != nullptr && heading->id == picture.section;
    });
    if (position == blocks.end()) return false;
    ++position;
  }
  position = std::find_if(position, blocks.end(), [](const Block& block) {
    return !std::holds_alternative<CitedText>(block) && !std::holds_alternative<Picture>(block);
  });
  blocks.insert(position, picture);
  return true;
}

void insert_picture(const Picture& picture, std::vector<Section>& sections) {
  if (picture.section.empty()) return;
  const bool is_placed = std::ranges::any_of(
      sections, [&](Section& section) { return insert_picture(picture, section); });
  if (!is_placed) sections.front().folded_blocks.emplace_back(picture);
}

/// If no picture belongs to the result, moves the first one of an unfolded section there.
Pictures with_result_picture(Pictures pictures, const std::vector<Section>& sections) {
  if (std::ranges::find(pictures, "result", &Picture::section) != pictures.end()) return pictures;
  const auto is_shown = [&](const std::string& id) {
    return std::ranges::any_of(sections, [&](const Section& section) {
      return section.id == id && !section.blocks.empty();
    });
  };
  const auto first = std::ranges::find_if(pictures, is_shown, &Picture::section);
  if (first != pictures.end()) first->section = "result";
  return pictures;
}

/// Participants, trials, dates and device.
CitedText facts_sentence(const StudyHead& head) {
  std::string text = fmt::format("{}, {}", counted(head.participants, "participant"),
                                 counted(head.trials, "trial"));
  if (const auto dates = dates_of(head.collection.sessions)) {
    text += dates->first == dates->last ? ", " + dates->first
                                        : fmt::format(", {} to {}", dates->first, dates->last);
  }
  text += ".";
  const std::string devices = device_summary(head.collection);
  if (!devices.empty()) text += " Device: " + devices + ".";
  if (head.registration.analysis && head.departures.empty()) {
    text += " No departures from the registration were recorded.";
  }
  return {text};
}

/// The most serious warnings come first; further ones are folded.
constexpr std::size_t kMaxUnfoldedWarnings = 4;

void add_warnings(const std::vector<std::string>& warnings, Section& section, std::size_t index) {
  const std::size_t unfolded_count = std::min(warnings.size(), kMaxUnfoldedWarnings);
  const auto end = warnings.begin() + static_cast<std::ptrdiff_t>(unfolded_count);
  if (unfolded_count > 0) {
    section.blocks.insert(section.blocks.begin() + static_cast<std::ptrdiff_t>(index),
                          Warnings{{warnings.begin(), end}, "What to bear in mind:"});
  }
  if (end != warnings.end()) {
    section.folded_blocks.insert(section.folded_blocks.begin(),
                                 Warnings{{end, warnings.end()}, "Further points:"});
  }
}

/// The first section: verdict, the protocol's sentences, facts, warnings, and tables.
Section result_section(const StudyHead& head, Section headline) {
  std::vector<Block> blocks = std::move(headline.blocks);
  headline.blocks.clear();
  add_verdict(head, headline);
  const auto first_table = std::ranges::find_if(
      blocks, [](const Block& block) { return std::holds_alternative<Table>(block); });
  headline.blocks.insert(headline.blocks.end(), blocks.begin(), first_table);
  headline.blocks.emplace_back(facts_sentence(head));
  if (!head.departures.empty()) {
    headline.blocks.emplace_back(Warnings{head.departures, head.registration.analysis
                                                               ? "Departures from the registration:"
                                                               : "Departures from the plan:"});
  }
  add_warnings(head.warnings, headline, headline.blocks.size());
  headline.blocks.insert(headline.blocks.end(), first_table, blocks.end());
  std::ranges::move(registration_blocks(head.registration),
                    std::back_inserter(headline.folded_blocks));
  return headline;
}

}  // namespace

Provenance provenance_of(const record::StudyStore& store, const std::string& database) {
  return {database,
          std::string(program_version()),
          to_hex(store.commitment().seal),
          store.file_head(),
          store.state(),
          prescription_from_json(store.commitment().configuration).draft,
          !store.commitment().simulated && any_ran_unverified(load_collection(store).sessions)};
}

std::string unverified_banner() {
  return std::string(study::kUnverifiedDevice) +
         ": sessions ran on a device without a valid acceptance certificate. What was felt is "
         "unknown.";
}

std::string further_stamp(bool pilot, const Provenance& provenance) {
  return joined(joined(pilot ? "PILOT" : "", is_interim(provenance) ? "INTERIM LOOK" : ""),
                provenance.unverified ? study::kUnverifiedDevice : "");
}

Document framed_document(const StudyHead& head, Section headline, std::vector<Section> results,
                         const Provenance& provenance, const Pictures& pictures) {
  Document document = empty_document("Report of the study ", head, provenance);
  add_interim_banner(provenance, document.banners);
  document.header.entries.emplace_back("textures", listed(head.classes, " and "));
  add_evidence(provenance, document.header);
  if (std::ranges::any_of(pictures, &std::string::empty, &Picture::svg)) {
    document.header.entries.emplace_back(
        "figures",
        "Figures are missing because gnuplot failed; `touchtrial report` printed the reason. Each "
        "figure is described in words instead.");
  }
  std::vector<Section> sections = {result_section(head, std::move(headline))};
  std::ranges::move(results, std::back_inserter(sections));
  sections.push_back(participants_section(head.collection, &head));
  sections.push_back(questionnaire_section(head));
  add_unadjusted_notes(head.looks, sections);
  for (const Picture& picture : with_result_picture(pictures, sections)) {
    insert_picture(picture, sections);
  };
  for (Section& section : sections) {
    if (!all_blocks(section).empty()) document.sections.push_back(std::move(section));
  }
  return document;
}

Document quality_document(const QualityReport& report, const Provenance& provenance) {
  Document document = empty_document("Quality of the study ", report, provenance);
  if (!report.state.unblinded) {
    document.banners.emplace_back(
        "BLIND: outcomes are shown once the study has been unblinded. Nothing here reveals them.");
  }
  if (report.visual) {
    document.banners.emplace_back(
        "Textures were seen on a screen, not felt: do not pool with data from touch.");
  }
  add_evidence(provenance, document.header);
  document.sections = quality_sections(report);
  return document;
}

}  // namespace touchtrial::analysis
