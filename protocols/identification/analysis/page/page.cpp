#include "analysis/report/page/wording.hpp"
#include "protocols/identification/analysis/page/sections.hpp"

#include <algorithm>
#include <array>
#include <string_view>

namespace touchtrial::analysis::identification {
namespace {

using std::string_view;

/// The section of a picture. A picture belongs to the section of the first entry whose `beginning`
/// starts its id.
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

/// The page shows the flow of participants itself, as text that can be read aloud. This picture is
/// for papers.
constexpr string_view kFlow = "participant-flow";
constexpr string_view kExploration = "exploration";

string_view section_for(const Picture& picture) {
  const auto* place = std::find_if(kPlaces.begin(), kPlaces.end(), [&](const PicturePlace& one) {
    return picture.id.starts_with(one.beginning);
  });
  return place == kPlaces.end() ? string_view() : place->section;
}

/// Inserts a picture before the section's first table or subheading, below its sentences.
void add_picture(const Picture& picture, Section& section) {
  const auto place =
      std::find_if(section.blocks.begin(), section.blocks.end(), [](const Block& one) {
        return std::holds_alternative<Table>(one) || std::holds_alternative<Subheading>(one);
      });
  section.blocks.insert(place, picture);
}

/// Adds the pictures of single explorations at the end of the section on cues.
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

/// Puts pictures into their sections.
/// \return the pictures that belong to no section
Pictures place_pictures(const Pictures& pictures, std::vector<Section>& sections) {
  Pictures left;
  // Each picture goes directly before the first table, so the pictures keep their order.
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

/// Capitalises the captions of tables. With several methods a caption begins with a method's name,
/// which must stay as it is.
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

/// Adds a section before the section on methods for pictures with unknown ids.
void add_further(const Pictures& pictures, Document& document) {
  if (pictures.empty()) return;
  Section further{"further-figures", "Further figures", {}};
  for (const Picture& one : pictures) further.blocks.emplace_back(one);
  document.sections.insert(document.sections.end() - 1, std::move(further));
}

/// Tells whether an earlier method has the same slug.
bool is_taken(const StudyReport& report, std::size_t method, const std::string& slug) {
  for (std::size_t i = 0; i < method; ++i) {
    if (slug_of(report.methods[i].method) == slug) return true;
  }
  return false;
}

}  // namespace

std::string method_slug(const StudyReport& report, std::size_t method) {
  const std::string slug = slug_of(report.methods[method].method);
  if (!slug.empty() && !is_taken(report, method, slug)) return slug;
  // No slug contains two hyphens in a row.
  return slug + "--" + std::to_string(method + 1);
}

void add_method_heading(const StudyReport& report, std::size_t method, Section& section) {
  if (report.methods.size() < 2) return;
  section.blocks.emplace_back(
      Subheading{section.id + "-of-" + method_slug(report, method), report.methods[method].method});
}

std::string method_prefix(const StudyReport& report, std::size_t method) {
  return report.methods.size() > 1 ? report.methods[method].method + ": " : "";
}

Document study_document(const StudyReport& report, const Provenance& provenance,
                        const Pictures& pictures) {
  const bool missing = std::ranges::any_of(pictures, &std::string::empty, &Picture::svg);
  Document document =
      framed_document(report, {"result", "Result", {}},
                      {accuracy_section(report), confusions_section(report),
                       comparison_section(report), visits_section(report), order_section(report),
                       confidence_section(report), times_section(report), cues_section(report),
                       robustness_section(report), methods_section(report)},
                      provenance, missing);
  if (report.methods.size() < 2) capitalise_captions(document);
  add_further(place_pictures(pictures, document.sections), document);
  return document;
}

}  // namespace touchtrial::analysis::identification
