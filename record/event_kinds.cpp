#include "record/event_kinds.hpp"

#include "record/file_bodies.hpp"
#include "record/session_bodies.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace touchtrial::record {
namespace {

using Kind = EventKind;

using Details = EventKindRow::Details;

constexpr Details kSafetyRecord{.in_safety_record = true};

constexpr Details text_details(std::string_view text, std::string_view secret_description = {}) {
  return {.text = text, .secret_description = secret_description};
}

constexpr Details secret_text_details(std::string_view description) {
  return {.secret_description = description};
}

template <typename Body>
constexpr Details secret_body_details(bool in_safety_record = false) {
  return {.secret = describe_body<Body>, .in_safety_record = in_safety_record};
}

constexpr auto kKinds = std::to_array<EventKindRow>({
    {Kind::study_committed, "study-committed", "the study is fixed before any trial",
     describe_body<StudyCommitment>},
    {Kind::session_opened, "session-opened", "binds a session's chain and keys to the file",
     describe_body<SessionOpenedBody>},
    {Kind::session_closed, "session-closed", "the end of the session's chain",
     describe_body<SessionClosedBody>},
    {Kind::participant_excluded, "participant-excluded", "the session was excluded",
     describe_body<ParticipantBody>},
    {Kind::participant_withdrawn, "participant-withdrawn", "the participant withdrew",
     describe_body<WithdrawalBody>},
    {Kind::study_closed, "study-closed", "collection ended", describe_body<EmptyBody>},
    {Kind::study_unblinded, "study-unblinded", "outcomes were viewed",
     describe_body<UnblindingBody>},
    {Kind::participant_replaced, "participant-replaced",
     "another participant took over the enrolment number", describe_body<ReplacementBody>},
    {Kind::participant_noted, "participant-noted", "a note or deviation after the session",
     describe_body<NoteBody>},
    {Kind::heads_kept, "heads-kept", "the head files of the database changed",
     describe_body<HeadsBody>},
    {Kind::loss_accepted, "loss-accepted",
     "a loss of events that the head file records was accepted", describe_body<LossBody>},

    {Kind::opened, "opened", "the session begins", describe_body<SessionOpening>, 8,
     secret_text_details("schedule and layout, JSON")},
    {Kind::calibrated, "calibrated", "the device was calibrated", describe_body<TextBody>, 1,
     text_details("how, or empty")},
    {Kind::instructed, "instructed", "the participant has read the instructions",
     describe_body<TextBody>, 1, text_details("how, or empty")},
    {Kind::practised, "practised", "the participant answered in practice",
     describe_body<PracticeBody>, 4},
    {Kind::presented, "presented", "a trial's plane appeared", describe_body<PresentedBody>},
    {Kind::first_contact, "first-contact", "the stylus came near the plane",
     describe_body<TrialBody>},
    {Kind::answered, "answered", "the participant answered", describe_body<AnswerBody>, 4},
    {Kind::interrupted, "interrupted", "a presentation was interrupted",
     describe_body<InterruptedBody>, 8, secret_body_details<InterruptionDetail>()},
    {Kind::timed_out, "timed-out", "the time limit was reached without an answer",
     describe_body<TrialBody>},
    {Kind::trace_stored, "trace-stored", "the trial's trace was stored", describe_body<TraceBody>,
     16, secret_body_details<TrialMeasures>()},
    {Kind::break_taken, "break-taken", "a break that the study prescribes", describe_body<TextBody>,
     1, text_details("empty, or a remark")},
    {Kind::paused, "paused", "the experimenter paused the session", describe_body<PauseBody>, 8},
    {Kind::stopped, "stopped", "the session was ended early", describe_body<StopBody>, 8,
     kSafetyRecord},
    {Kind::noted, "noted", "the experimenter took a note", describe_body<RemarkBody>, 8},
    {Kind::ticked, "ticked", "an item of the day sheet is done", describe_body<TextBody>, 1,
     text_details("code of the item")},
    {Kind::deviated, "deviated", "a deviation from the protocol", describe_body<DeviationBody>, 8,
     kSafetyRecord},
    {Kind::questioned, "questioned", "a questionnaire was filled in", describe_body<TextBody>, 8,
     text_details("name of the questionnaire", "the answers, JSON")},
    {Kind::explored_again, "explored-again",
     "the participant returned to the plane before answering", describe_body<TrialBody>},
    {Kind::block_restarted, "block-restarted", "a block was restarted", describe_body<BlockBody>, 8,
     secret_text_details("the block in its new order, JSON")},
    {Kind::resumed, "resumed", "the session was resumed", describe_body<ResumedBody>, 2},
    {Kind::marked, "marked", "marks were sent to other instruments since the last such event",
     describe_body<EmptyBody>, 32, secret_body_details<MarksBody>()},
    {Kind::closed, "closed", "the session ends", describe_body<ClosedBody>, 8,
     secret_body_details<ChainEnd>(true)},
});

constexpr bool rows_follow_kinds() {
  for (std::size_t i = 0; i < kKinds.size(); ++i) {
    if (static_cast<std::size_t>(kKinds[i].kind) != i) return false;
  }
  return kKinds.size() == static_cast<std::size_t>(Kind::closed) + 1;
}
static_assert(rows_follow_kinds());

std::string range_words(std::int64_t min) {
  return min == 0 ? "" : " from " + std::to_string(min);
}

/// Lists the members of a body, regardless of their values.
class MemberList final : public BodyIo {
 public:
  std::vector<ListedMember> list;

 private:
  void add(const Member& member, std::string type) { list.push_back({member, std::move(type)}); }

  bool has(const Member& /*member*/, bool /*has_value*/) override { return true; }
  void text(const Member& member, std::string& /*value*/) override { add(member, "text"); }
  void boolean(const Member& member, bool& /*value*/) override { add(member, "true or false"); }
  void number(const Member& member, double& /*value*/) override { add(member, "number"); }
  void integer(const Member& member, std::int64_t& /*value*/, std::int64_t /*max*/) override {
    add(member, "whole number" + range_words(member.note.min));
  }
  void bytes(const Member& member, std::span<std::uint8_t> value) override {
    add(member, std::to_string(2 * value.size()) + " hexadecimal digits");
  }
  void word(const Member& member, std::size_t& /*index*/,
            std::span<const std::string_view> words) override {
    std::string word_list;
    for (const std::string_view word : words) {
      word_list += (word_list.empty() ? "`" : ", `") + std::string(word) + "`";
    }
    add(member, std::move(word_list));
  }
  void numbers(const Member& member, std::span<double> value) override {
    add(member, std::to_string(value.size()) + " numbers");
  }
  void numbers(const Member& member, std::vector<double>& /*value*/) override {
    add(member, "list of numbers");
  }
  void integers(const Member& member, std::vector<std::int64_t>& /*value*/,
                std::int64_t /*max*/) override {
    add(member, "list of whole numbers" + range_words(member.note.min));
  }
  void object(const Member& member, const std::function<void(BodyIo&)>& describe) override {
    add(member, "object");
    MemberList inner;
    describe(inner);
    list.back().within = std::move(inner.list);
  }
};

}  // namespace

std::span<const EventKindRow> event_kinds() {
  return kKinds;
}

const EventKindRow& row_of(EventKind kind) {
  return kKinds.at(static_cast<std::size_t>(kind));
}

std::string_view name_of(EventKind kind) {
  return row_of(kind).name;
}

std::optional<EventKind> event_kind_from_name(std::string_view name) {
  const auto* const row = std::ranges::find(kKinds, name, &EventKindRow::name);
  return row == kKinds.end() ? std::nullopt : std::optional(row->kind);
}

std::vector<ListedMember> members_of(DescribeBody describe) {
  MemberList members;
  describe(members);
  return std::move(members.list);
}

const std::vector<ListedMember>& members_of(EventKind kind) {
  static const auto members = [] {
    std::vector<std::vector<ListedMember>> members_by_kind;
    for (const EventKindRow& row : kKinds) members_by_kind.push_back(members_of(row.body));
    return members_by_kind;
  }();
  return members.at(static_cast<std::size_t>(kind));
}

}  // namespace touchtrial::record
