#include "analysis/page/study_document.hpp"

#include "analysis/page/sections.hpp"
#include "analysis/page/wording.hpp"
#include "analysis/text_figures.hpp"

#include <algorithm>
#include <array>
#include <string_view>

#include <fmt/format.h>

namespace touchtrial::analysis {
namespace {

using std::string_view;

/// Where pictures stand: an id that begins so belongs to that section; the first that fits.
struct PicturePlace {
  string_view beginning;
  string_view section;
};
constexpr std::array<PicturePlace, 12> kPlaces{{{"accuracy-by-class", "accuracy"},
                                                {"accuracy-over-trials", "order"},
                                                {"accuracy-by-trial", "order"},
                                                {"accuracy", "accuracy"},
                                                {"participants", "accuracy"},
                                                {"methods", "methods-compared"},
                                                {"confusion", "confusions"},
                                                {"reaction", "reaction-times"},
                                                {"observers", "cues"},
                                                {"ideal", "cues"},
                                                {"cue", "cues"},
                                                {"servo", "servo-and-validity"}}};

/// The page draws participants' flow itself, as text that can be read aloud: this is for papers.
constexpr string_view kFlow = "participant-flow";
constexpr string_view kExploration = "exploration";

string_view section_for(const Picture& picture) {
  const auto* place = std::find_if(kPlaces.begin(), kPlaces.end(), [&](const PicturePlace& one) {
    return picture.id.starts_with(one.beginning);
  });
  return place == kPlaces.end() ? string_view() : place->section;
}

/// Pictures stand before the section's first table or subheading, and below its sentences.
void add_picture(const Picture& picture, Section& section) {
  const auto place =
      std::find_if(section.blocks.begin(), section.blocks.end(), [](const Block& one) {
        return std::holds_alternative<Table>(one) || std::holds_alternative<Subheading>(one);
      });
  section.blocks.insert(place, picture);
}

/// What single hands did comes last among the cues.
void add_explorations(const Pictures& pictures, std::vector<Section>& sections) {
  const auto cues = std::find_if(sections.begin(), sections.end(),
                                 [](const Section& one) { return one.id == "cues"; });
  if (cues == sections.end()) return;
  bool first = true;
  for (const Picture& picture : pictures) {
    if (!picture.id.starts_with(kExploration)) continue;
    if (first) cues->blocks.emplace_back(Subheading{"explorations", "How a hand explored"});
    first = false;
    cues->blocks.emplace_back(picture);
  }
}

/// \return those that belong to no section
Pictures place_pictures(const Pictures& pictures, std::vector<Section>& sections) {
  Pictures left;
  // Each is put before the section's first table, so the last one comes last.
  for (const Picture& picture : pictures) {
    if (picture.id == kFlow || picture.id.starts_with(kExploration)) continue;
    const string_view wanted = section_for(picture);
    const auto section = std::find_if(sections.begin(), sections.end(),
                                      [&](const Section& one) { return one.id == wanted; });
    if (section == sections.end()) {
      left.push_back(picture);
    } else {
      add_picture(picture, *section);
    }
  }
  add_explorations(pictures, sections);
  return left;
}

std::string joined(const std::string& first, const std::string& second) {
  return first + (first.empty() || second.empty() ? "" : ", ") + second;
}

bool is_interim(const Provenance& provenance) {
  return provenance.state.unblinded && !provenance.state.closed;
}

std::vector<std::string> banners_of(const StudyReport& report, const Provenance& provenance) {
  std::vector<std::string> banners;
  if (report.simulated) {
    banners.emplace_back(
        "SIMULATED: these figures come from simulated participants. They say what a model of a "
        "hand and of a sense of touch does, not what people do.");
  }
  if (report.pilot) {
    banners.emplace_back("PILOT: not to be pooled with the study's data, nor reported as it.");
  }
  if (is_interim(provenance)) {
    banners.emplace_back(
        "INTERIM LOOK: the study is still open. What is seen here may not decide when it ends.");
  }
  return banners;
}

Definitions header_of(const StudyReport& report, const Provenance& provenance,
                      const Pictures& pictures) {
  Definitions header;
  header.entries = {{"protocol", report.protocol},
                    {"participants", std::to_string(report.participants)},
                    {"trials", std::to_string(report.trials)},
                    {"textures", listed(report.classes)}};
  const Definitions evidence = evidence_header(provenance);
  header.entries.insert(header.entries.end(), evidence.entries.begin(), evidence.entries.end());
  const bool missing = std::any_of(pictures.begin(), pictures.end(),
                                   [](const Picture& one) { return one.svg.empty(); });
  if (missing) {
    header.entries.emplace_back(
        "figures",
        "Figures were not drawn: gnuplot could not be used. Install "
        "gnuplot-nox and make the report again; here each is told in words.");
  }
  return header;
}

/// Sections that have anything to say.
void add_sections(const StudyReport& report, Document& document) {
  for (Section section :
       {headline_section(report), warnings_section(report), participants_section(report.collection),
        registration_section(report.registration), accuracy_section(report),
        confusions_section(report), comparison_section(report), order_section(report),
        times_section(report), cues_section(report), robustness_section(report),
        methods_section(report)}) {
    if (!section.blocks.empty()) document.sections.push_back(std::move(section));
  }
}

/// With several methods a caption begins with a method's name, which stays as it is.
void capitalise_captions(Document& document) {
  for (Section& section : document.sections) {
    for (Block& block : section.blocks) {
      auto* table = std::get_if<Table>(&block);
      if (table == nullptr || table->caption.empty()) continue;
      char& first = table->caption.front();
      if (first >= 'a' && first <= 'z') first = static_cast<char>(first - 'a' + 'A');
    }
  }
}

/// What is in the way is an unknown picture's: before the section on methods.
void add_further(const Pictures& pictures, Document& document) {
  if (pictures.empty()) return;
  Section further{"further-figures", "Further figures", {}};
  for (const Picture& one : pictures) further.blocks.emplace_back(one);
  document.sections.insert(document.sections.end() - 1, std::move(further));
}

}  // namespace

std::string further_stamp(const StudyReport& report, const Provenance& provenance) {
  return joined(report.pilot ? "PILOT" : "", is_interim(provenance) ? "INTERIM LOOK" : "");
}

Document study_document(const StudyReport& report, const Provenance& provenance,
                        const Pictures& pictures) {
  Document document;
  document.title = "Report of the study " + report.study;
  document.stamp = joined(report.simulated ? "SIMULATED" : "", further_stamp(report, provenance));
  document.banners = banners_of(report, provenance);
  document.header = header_of(report, provenance, pictures);
  add_sections(report, document);
  if (report.methods.size() < 2) capitalise_captions(document);
  add_further(place_pictures(pictures, document.sections), document);
  document.colophon =
      fmt::format("{}touchtrial {}, {}, event {} of the file's chain, {}",
                  simulated_line(report.simulated), provenance.program_version, provenance.database,
                  provenance.head.length, to_hex(provenance.head.hash));
  return document;
}

}  // namespace touchtrial::analysis
