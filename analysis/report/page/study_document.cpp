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
           "; blind but for the registered question (" + state.unblinding_reason + ")";
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

std::vector<std::string> banners_of(const StudyHead& report, const Provenance& provenance) {
  std::vector<std::string> banners;
  if (report.simulated) {
    const std::string device = simulated_on(simulated_devices(report.collection));
    if (!device.empty()) banners.push_back(device);
    banners.emplace_back(
        "SIMULATED: these numbers come from simulated participants. They say what a model of a "
        "hand and of a sense of touch does, not what people do.");
  }
  if (report.pilot) {
    banners.emplace_back("PILOT: not to be pooled with the study's data, nor reported as it.");
  }
  if (provenance.unverified) banners.push_back(unverified_banner());
  if (provenance.lacks) banners.push_back(provenance.vouched);
  if (provenance.state.question) {
    banners.emplace_back(
        "INTERIM LOOK at the registered question: it alone is shown, and it alone may decide "
        "whether collecting ends here. Everything else stays blind until the study is closed.");
  } else if (is_interim(provenance)) {
    banners.emplace_back(
        "INTERIM LOOK: the study is still open. What it shows must not decide when the study "
        "ends.");
  }
  return banners;
}

Definitions header_of(const StudyHead& report, const Provenance& provenance,
                      const Pictures& pictures) {
  Definitions header;
  header.entries = {{"protocol", report.protocol},
                    {"participants", std::to_string(report.participants)},
                    {"trials", std::to_string(report.trials)},
                    {"textures", listed(report.classes, " and ")}};
  const Definitions evidence = evidence_header(provenance);
  header.entries.insert(header.entries.end(), evidence.entries.begin(), evidence.entries.end());
  if (std::ranges::any_of(pictures, &std::string::empty, &Picture::svg)) {
    header.entries.emplace_back(
        "figures",
        "Figures were not drawn: gnuplot could not be used, for the reason that `touchtrial "
        "report` "
        "said. Make the report again where it can; here each is described in words.");
  }
  return header;
}

/// Puts a picture below the sentences of a section or subheading, if it belongs there.
void place(const Picture& picture, Section& section) {
  auto at = section.blocks.begin();
  if (section.id != picture.section) {
    at = std::ranges::find_if(section.blocks, [&](const Block& one) {
      const auto* heading = std::get_if<Subheading>(&one);
      return heading != nullptr && heading->id == picture.section;
    });
    if (at == section.blocks.end()) return;
    ++at;
  }
  at = std::find_if(at, section.blocks.end(), [](const Block& one) {
    return std::holds_alternative<Table>(one) || std::holds_alternative<Subheading>(one);
  });
  section.blocks.insert(at, picture);
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
         ": sessions ran on a device without a valid acceptance. Nobody knows what was felt.";
}

Definitions evidence_header(const Provenance& provenance) {
  Definitions header{
      {{"state", state_words(provenance.state)},
       {"database", provenance.database},
       {"seal of the study", provenance.seal},
       {"head of the file's chain",
        fmt::format("{} (event {})", to_hex(provenance.head.hash), provenance.head.length)},
       {"program", "touchtrial " + provenance.program_version}}};
  if (!provenance.vouched.empty()) {
    header.entries.emplace_back("its end is vouched for", provenance.vouched);
  }
  if (!provenance.texts.empty()) {
    header.entries.emplace_back("what participants read", provenance.texts);
  }
  return header;
}

std::string further_stamp(bool pilot, const Provenance& provenance) {
  return joined(joined(pilot ? "PILOT" : "", is_interim(provenance) ? "INTERIM LOOK" : ""),
                provenance.unverified ? study::kUnverifiedDevice : "");
}

Section warnings_section(const std::vector<std::string>& warnings) {
  Section section{"to-bear-in-mind", "What to bear in mind", {}};
  if (!warnings.empty()) section.blocks.emplace_back(Warnings{warnings});
  return section;
}

Document framed_document(const StudyHead& head, Section headline, std::vector<Section> results,
                         const Provenance& provenance, const Pictures& pictures) {
  Document document;
  document.title = "Report of the study " + head.study;
  document.stamp = joined(head.simulated ? "SIMULATED" : "", further_stamp(head.pilot, provenance));
  document.banners = banners_of(head, provenance);
  document.header = header_of(head, provenance, pictures);
  std::vector<Block> verdict = verdict_blocks(head);
  headline.blocks.insert(headline.blocks.begin(), std::make_move_iterator(verdict.begin()),
                         std::make_move_iterator(verdict.end()));
  std::vector<Section> sections = {std::move(headline),
                                   participants_section(head.collection, &head),
                                   exploration_section(head),
                                   said_section(head),
                                   warnings_section(head.warnings),
                                   registration_section(head.registration)};
  std::ranges::move(results, std::back_inserter(sections));
  say_unadjusted(head.looks, sections);
  for (const Picture& picture : pictures) {
    for (Section& section : sections) place(picture, section);
  }
  for (Section& section : sections) {
    if (!section.blocks.empty()) document.sections.push_back(std::move(section));
  }
  document.colophon =
      fmt::format("{}touchtrial {}, {}, event {} of the file's chain, {}",
                  simulated_line(head.simulated), provenance.program_version, provenance.database,
                  provenance.head.length, to_hex(provenance.head.hash));
  return document;
}

}  // namespace touchtrial::analysis
