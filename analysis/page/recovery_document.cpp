#include "analysis/page/recovery_document.hpp"

#include "core/errors.hpp"
#include "core/version.hpp"
#include "protocols/design/recovery_sheet.hpp"

#include <fmt/format.h>

namespace touchtrial::analysis {
namespace {

Section purpose_of(const design::StudyKey& key) {
  return {
      .id = "purpose",
      .title = "What it is good for",
      .blocks = {
          Definitions{{{"study", key.study.name},
                       {"identity", key.study_id},
                       {"seal", to_hex(key.seal)},
                       {"program", fmt::format("Touchtrial {}", program_version())}}},
          Cited{"The lines below are the investigator's key. Every secret of the study follows "
                "from them: the schedules, the meaning of the codes, and what opens the "
                "sessions. Whoever reads this sheet can open every session of the study."},
          Cited{"Keep it on paper, away from the stations and from the copies of the key, and "
                "delete the file from which it was printed. Print a new one when the study file "
                "or the plan of enrolment numbers has changed."}}};
}

Section lines_of_key(const design::StudyKey& key) {
  Definitions lines;
  for (const std::string& line : design::recovery_lines(key)) {
    lines.entries.emplace_back(std::to_string(lines.entries.size() + 1), line);
  }
  return {
      .id = "lines",
      .title = "Lines",
      .blocks = {
          std::move(lines),
          Cited{"Lines 1 to 4 are the secret, and line 5 has the number of lines and digits of "
                "the study's identity. Line 6 has digits of its seal, and each of the others a "
                "station with its enrolment numbers. The last four digits of a line check it."},
          Cited{"Digits are 0 to 9 and a to f. Spaces and capitals make no difference, and o is "
                "read as 0, l and i as 1. Names of stations are typed as they are printed."}}};
}

Section restoring() {
  return {
      .id = "restoring",
      .title = "How to make the key again",
      .blocks = {
          Cited{
              "Take the study file as it was when the study was prepared, and run `touchtrial key "
              "restore STUDY --out KEY`. Type the lines, each with its number and a colon, for "
              "instance \"1: 7f3a 9c01 22be 4d5e a1b2\". A line with a typing error is named at "
              "once and asked for again."},
          Cited{"`touchtrial key check DB --key KEY` then tells whether the key opens a database's "
                "sessions. `touchtrial prepare STUDY`, with the key beside the study file, writes "
                "the stations' files again."}}};
}

}  // namespace

Document recovery_document(const design::StudyKey& key) {
  if (key.simulated) {
    throw UsageError("study " + one_line(key.study.name) +
                     ": is simulated; its key follows from the study file and needs no sheet");
  }
  Document document;
  document.title = "Recovery sheet of the study " + key.study.name;
  document.banners = {"SECRET: opens every session. For the investigator alone."};
  document.sections = {purpose_of(key), lines_of_key(key), restoring()};
  return document;
}

}  // namespace touchtrial::analysis
