#include "analysis/report/methods.hpp"

#include "analysis/outcomes/recorded_pack.hpp"
#include "analysis/report/methods_parts.hpp"
#include "core/errors.hpp"
#include "engine/rendering/field_statistics.hpp"
#include "record/payload_json.hpp"

#include <algorithm>
#include <set>
#include <stdexcept>
#include <utility>

namespace touchtrial::analysis {
namespace {

constexpr const char* kSection = "methods";
constexpr const char* kStimuli = "methods-stimuli";

/// The servo rate in the first trace of the study.
std::optional<double> rate_of(const record::StudyStore& store) {
  for (const record::SessionRow& session : store.sessions()) {
    if (session.erased) continue;
    for (const record::Event& event : store.events(session.session)) {
      if (event.kind != record::EventKind::trace_stored) continue;
      const double rate_hz = record::from_json<record::TraceBody>(event.body).rate_hz;
      return rate_hz > 0.0 ? std::optional(rate_hz) : std::nullopt;
    }
  }
  return std::nullopt;
}

void add_pack(const engine::Pack& pack, const study::StudyKey& key, RecordedStudy& recorded) {
  RecordedStudy complete = recorded;
  try {
    for (const study::KeyedStimulus& stimulus : key.stimuli) {
      const engine::Gains gains = pack.entry(stimulus.code).gains;
      const engine::MappedField field = pack.map(stimulus.code);
      const PlaneGeometry plane = field.view().geometry;
      complete.gains.push_back(gains);
      complete.lateral_rms_n.push_back(
          engine::field_statistics(field.view(), gains, key.study.rendering).tangential_rms_n);
      if (std::ranges::find(complete.planes, plane) == complete.planes.end())
        complete.planes.push_back(plane);
    }
  } catch (const FileError&) {
    return;  // the pack is damaged
  } catch (const std::invalid_argument&) {
    return;
  }
  recorded = std::move(complete);
}

}  // namespace

RecordedStudy recorded_study(const record::StudyStore& store, const study::StudyKey& key) {
  const record::StudyCommitment& commitment = store.commitment();
  RecordedStudy recorded{.program_version = commitment.program_version,
                         .seal = to_hex(commitment.seal),
                         .pack = to_hex(commitment.pack),
                         .rate_hz = rate_of(store)};
  if (const auto pack = pack_of(store, key)) add_pack(*pack, key, recorded);
  return recorded;
}

Section methods_section(const StudyHead& head, const Outcomes& outcomes,
                        const RecordedStudy& recorded, const ProtocolMethods& protocol) {
  Section section{kSection, "Methods", {}, true};
  const auto add = [&section](const char* id, const char* title, CitedText paragraph) {
    section.blocks.emplace_back(Subheading{id, title});
    section.blocks.emplace_back(std::move(paragraph));
  };
  add("methods-participants", "Participants", participants_paragraph(head, outcomes));
  add(kStimuli, "Apparatus and stimuli", stimuli_paragraph(head, outcomes, recorded));
  add("methods-procedure", "Procedure", procedure_paragraph(head, outcomes, protocol));
  add("methods-analysis", "Data analysis", analysis_paragraph(outcomes, recorded, protocol));
  return section;
}

void add_to_stimuli(Document& document, const std::string& sentence) {
  const auto section = std::ranges::find(document.sections, kSection, &Section::id);
  if (section == document.sections.end() || sentence.empty()) return;
  auto block = section->blocks.begin();
  for (; block != section->blocks.end(); ++block) {
    const auto* heading = std::get_if<Subheading>(&*block);
    if (heading != nullptr && heading->id == kStimuli) break;
  }
  for (; block != section->blocks.end(); ++block) {
    auto* paragraph = std::get_if<CitedText>(&*block);
    if (paragraph == nullptr) continue;
    paragraph->text += ' ' + sentence;
    return;
  }
}

std::string methods_markdown(const Document& document) {
  const auto section = std::ranges::find(document.sections, kSection, &Section::id);
  if (section == document.sections.end()) return {};
  Document methods_only;
  methods_only.title = document.title;
  methods_only.stamp = document.stamp;
  methods_only.banners = document.banners;
  methods_only.sections = {*section};
  methods_only.colophon = document.colophon;
  return document_markdown(methods_only, "figures");
}

std::string author_and_year(Source source) {
  const std::string_view text = citation_of(source);
  const std::size_t open = text.find(" (");
  std::string_view authors = text.substr(0, open);
  std::vector<std::string> names;
  while (!authors.empty()) {
    const std::size_t comma = std::min(authors.find(", "), authors.size());
    const std::string_view name = authors.substr(0, comma);
    names.emplace_back(name.substr(0, name.find(' ')));
    authors.remove_prefix(std::min(comma + 2, authors.size()));
  }
  std::string citation = names.front();
  if (names.size() == 2) citation += " and " + names.back();
  if (names.size() > 2) citation += " et al.";
  return citation + ", " + std::string(text.substr(open + 2, text.find(')', open) - open - 2));
}

std::string joined_fields(const std::vector<std::pair<std::string, std::string>>& fields) {
  std::string text;
  for (const auto& [name, value] : fields) {
    text += (text.empty() ? "" : "; ") + name + ": " + value;
  }
  return text;
}

std::string quoted_statement(const std::string& text) {
  std::string line = text;
  std::ranges::replace(line, '\n', ' ');
  return "“" + line + "”";
}

std::vector<const SessionRecord*> counted_records(const StudyHead& head, const Outcomes& outcomes) {
  std::set<int> counted;
  for (const SessionOutcome& session : outcomes.sessions) {
    if (session.counted) counted.insert(session.row.session);
  }
  std::vector<const SessionRecord*> records;
  for (const SessionRecord& session : head.collection.sessions) {
    if (counted.contains(session.row.session)) records.push_back(&session);
  }
  return records;
}

void Paragraph::add(std::string_view sentence, const std::vector<Source>& sources) {
  if (sentence.empty()) return;
  std::string text(sentence);
  if (!sources.empty()) {
    std::string names;
    for (const Source source : sources) {
      names += (names.empty() ? "" : "; ") + author_and_year(source);
      if (std::ranges::find(cited_.sources, source) == cited_.sources.end()) {
        cited_.sources.push_back(source);
      }
    }
    text.insert(text.size() - 1, " (" + names + ")");
  }
  cited_.text += (cited_.text.empty() ? "" : " ") + text;
}

void Paragraph::add(const Sentences& sentences) {
  for (const CitedText& sentence : sentences) add(sentence.text, sentence.sources);
}

}  // namespace touchtrial::analysis
