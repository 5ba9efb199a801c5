/// \file The words of the study file and the values they stand for. For sources only.
#pragma once

#include "core/strict_json.hpp"
#include "protocols/design/study.hpp"

#include <array>
#include <string_view>

namespace touchtrial::design {

inline constexpr std::array kProtocolNames = {
    Named<Protocol>{"classification", Protocol::classification},
    Named<Protocol>{"comparison", Protocol::comparison}};

inline constexpr std::array kTrialOrderNames = {
    Named<TrialOrder>{"shuffled", TrialOrder::shuffled},
    Named<TrialOrder>{"de-bruijn", TrialOrder::de_bruijn},
    Named<TrialOrder>{"uniform", TrialOrder::uniform},
    Named<TrialOrder>{"williams", TrialOrder::williams}};

inline constexpr std::array kOnTimeoutNames = {
    Named<OnTimeout>{"fade", OnTimeout::fade},
    Named<OnTimeout>{"no-response", OnTimeout::no_response}};

inline constexpr std::array kBlocksNames = {Named<Blocks>{"by-method", Blocks::by_method},
                                            Named<Blocks>{"mixed", Blocks::mixed}};

inline constexpr std::array kOnInterruptionNames = {
    Named<OnInterruption>{"repeat", OnInterruption::repeat},
    Named<OnInterruption>{"leave-out", OnInterruption::leave_out},
    Named<OnInterruption>{"restart-block", OnInterruption::restart_block}};

inline constexpr std::array kSightNames = {Named<Sight>{"curtain", Sight::curtain},
                                           Named<Sight>{"blindfold", Sight::blindfold}};

inline constexpr std::array kQuestionKindNames = {
    Named<QuestionKind>{"choice", QuestionKind::choice},
    Named<QuestionKind>{"number", QuestionKind::number},
    Named<QuestionKind>{"text", QuestionKind::text}};

inline constexpr std::array kModelNames = {
    Named<engine::ModelKind>{"paper", engine::ModelKind::paper},
    Named<engine::ModelKind>{"surface", engine::ModelKind::surface}};

inline constexpr std::array kEqualiseNames = {
    Named<engine::Equalise>{"none", engine::Equalise::none},
    Named<engine::Equalise>{"rms", engine::Equalise::rms}};

/// The word for a value; every value of the enumeration is in its table.
template <typename Value, std::size_t size>
[[nodiscard]] constexpr std::string_view word_for(const std::array<Named<Value>, size>& table,
                                                  Value value) {
  for (const Named<Value>& entry : table) {
    if (entry.value == value) return entry.name;
  }
  return {};
}

}  // namespace touchtrial::design
