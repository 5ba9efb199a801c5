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

/// Warnings at the top of the page.
template <typename Report>
std::vector<std::string> banners_of(const Report& report, const Provenance& provenance) {
  std::vector<std::string> banners;
  if (report.simulated) {
    const std::string device = simulated_on(simulated_devices(report.collection));
    if (!device.empty()) banners.push_back(device);
    banners.emplace_back(
        "SIMULATED: these numbers come from simulated participants. They say what a model of a "
        "hand and of a sense of touch does, not what people do.");
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
        "INTERIM LOOK at the registered question: it alone is shown, and it alone may decide "
        "whether collecting ends here. Everything else stays blind until the study is closed.");
  } else if (is_interim(provenance)) {
    banners.emplace_back(
        "INTERIM LOOK: the study is still open. What it shows must not decide when the study "
        "ends.");
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
    entries.emplace_back("its end is vouched for", provenance.head_summary);
  }
  if (!provenance.texts.empty()) entries.emplace_back("what participants read", provenance.texts);
}

/// Puts a picture below the sentences of a section or subheading.
/// \return whether it belongs there
bool place(const Picture& picture, Section& section) {
  std::vector<Block>& blocks = section.is_folded() ? section.more : section.blocks;
  auto at = blocks.begin();
  if (section.id != picture.section) {
    at = std::ranges::find_if(blocks, [&](const Block& one) {
      const auto* heading = std::get_if<Subheading>(&one);
      return heading != nullptr && heading->id == picture.section;
    });
    if (at == blocks.end()) return false;
    ++at;
  }
  at = std::find_if(at, blocks.end(), [](const Block& one) {
    return !std::holds_alternative<Cited>(one) && !std::holds_alternative<Picture>(one);
  });
  blocks.insert(at, picture);
  return true;
}

void place(const Picture& picture, std::vector<Section>& sections) {
  if (picture.section.empty()) return;
  const bool placed =
      std::ranges::any_of(sections, [&](Section& section) { return place(picture, section); });
  if (!placed) sections.front().more.emplace_back(picture);
}

/// The pictures. If none belongs to the result, the first one of a section that is not folded moves
/// there.
Pictures with_leading(Pictures pictures, const std::vector<Section>& sections) {
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

/// What the result is about: how many people, on which device, and when.
Cited facts_sentence(const StudyHead& head) {
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
constexpr std::size_t kShownWarnings = 4;

void add_warnings(const std::vector<std::string>& warnings, Section& section, std::size_t at) {
  const std::size_t shown = std::min(warnings.size(), kShownWarnings);
  const auto end = warnings.begin() + static_cast<std::ptrdiff_t>(shown);
  if (shown > 0) {
    section.blocks.insert(section.blocks.begin() + static_cast<std::ptrdiff_t>(at),
                          Warnings{{warnings.begin(), end}, "What to bear in mind:"});
  }
  if (end != warnings.end()) {
    section.more.insert(section.more.begin(), Warnings{{end, warnings.end()}, "Further points:"});
  }
}

/// The first section: the verdict, the protocol's sentences, what it is about, what to bear in
/// mind, and then tables.
Section result_section(const StudyHead& head, Section headline) {
  std::vector<Block> own = std::move(headline.blocks);
  headline.blocks.clear();
  add_verdict(head, headline);
  const auto first_table = std::ranges::find_if(
      own, [](const Block& one) { return std::holds_alternative<Table>(one); });
  headline.blocks.insert(headline.blocks.end(), own.begin(), first_table);
  headline.blocks.emplace_back(facts_sentence(head));
  if (!head.departures.empty()) {
    headline.blocks.emplace_back(Warnings{head.departures, head.registration.analysis
                                                               ? "Departures from the registration:"
                                                               : "Departures from the plan:"});
  }
  add_warnings(head.warnings, headline, headline.blocks.size());
  headline.blocks.insert(headline.blocks.end(), first_table, own.end());
  std::ranges::move(registration_blocks(head.registration), std::back_inserter(headline.more));
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
         ": sessions ran on a device without a valid acceptance. What was felt is not known.";
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
  // Methods come here, the last before what is folded, the references and the header.
  note_unadjusted(head.looks, sections);
  for (const Picture& picture : with_leading(pictures, sections)) place(picture, sections);
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
        "Seen on a screen, not felt: never to be pooled with what was felt.");
  }
  add_evidence(provenance, document.header);
  document.sections = quality_sections(report);
  return document;
}

}  // namespace touchtrial::analysis
