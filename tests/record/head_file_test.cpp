#include "record/head_file.hpp"

#include "core/files.hpp"
#include "record/store_fixture.hpp"
#include "support/catch.hpp"
#include "support/refusal.hpp"

#include <csignal>
#include <fstream>
#include <limits>
#include <thread>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

using namespace touchtrial;
using namespace touchtrial::record;
using namespace touchtrial::fixture;

namespace {

constexpr std::size_t kSlot = 12288;  ///< bytes, as docs/data-dictionary.md says

const Signer& station_signer() {
  static const Signer signer(digest_of("a station's secret"));
  return signer;
}

const Signer& investigator_signer() {
  static const Signer signer(digest_of("an investigator's secret"));
  return signer;
}

const std::vector<PublicKey>& known_signers() {
  static const std::vector<PublicKey> signers = {station_signer().public_half(),
                                                 investigator_signer().public_half()};
  return signers;
}

HeadRecord some_record() {
  return {.study_id = commitment().study_id,
          .station = "room \"4\"\n\u00fc",
          .database = digest_of("first event"),
          .count = 1,
          .file = {.length = 9, .hash = digest_of("file")},
          .sessions = {{3, {.length = 57, .hash = digest_of("third")}},
                       {4, {.length = 2, .hash = digest_of("fourth")}}},
          .acknowledged = 75,
          .also = "/media/lab disk"};
}

HeadChange becomes(const HeadRecord& record) {
  return [record](HeadRecord& changed) { changed = record; };
}

void count_one_more(HeadRecord& record) {
  ++record.acknowledged;
}

/// The message of a FileError; empty if there is none.
template <typename Work>
std::string unreadable(Work&& work) {
  return message_of<FileError>([&] { work(); });
}

/// A folder with a head file that was written twice: its copies differ.
struct WrittenHead {
  WrittenHead() {
    file.update(station_signer(), becomes(some_record()));
    file.update(station_signer(), count_one_more);
  }

  [[nodiscard]] std::string bytes() const { return text_of(read_file(file.path())); }
  void put(const std::string& bytes) const {
    std::ofstream(file.path(), std::ios::binary | std::ios::trunc) << bytes;
  }
  [[nodiscard]] std::optional<HeadRecord> read() const { return file.read(known_signers()); }
  [[nodiscard]] std::string refusal() const {
    return unreadable([&] { static_cast<void>(read()); });
  }

  TempFolder folder;
  HeadFile file{folder.path() / "study.db.head"};
};

/// A database's place, and a second folder for its head file.
struct TwoDisks {
  TwoDisks() { std::filesystem::create_directory(disk); }

  TempFolder folder;
  std::filesystem::path database = folder.path() / "study.db";
  std::filesystem::path disk = folder.path() / "disk";
};

/// Two databases of one name whose second head files share a folder.
struct TwoDatabases : TwoDisks {
  TwoDatabases() {
    std::filesystem::create_directory(folder.path() / "one");
    std::filesystem::create_directory(folder.path() / "two");
  }

  std::filesystem::path one = folder.path() / "one" / "study.db";
  std::filesystem::path two = folder.path() / "two" / "study.db";
};

/// A record after `writes` writes of a WrittenHead.
HeadRecord after(std::int64_t writes) {
  HeadRecord record = some_record();
  record.count = writes;
  record.acknowledged += writes - 1;
  return record;
}

struct ExpectedLoss {
  int session;
  std::string words;  ///< that its sentence names in this order
  std::int64_t answers = 0;
};

void require_losses(const std::vector<Loss>& found, const std::vector<ExpectedLoss>& expected) {
  REQUIRE(found.size() == expected.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    INFO(found[i].what);
    REQUIRE(found[i].session == expected[i].session);
    if (!expected[i].words.empty()) REQUIRE(names_in_order(found[i].what, expected[i].words));
    REQUIRE(found[i].answers == expected[i].answers);
  }
}

/// An open session, stored event by event.
struct OpenSession {
  OpenSession(StudyStore& store, int session)
      : sink(store.begin_session(session, wrapped_key_of(session))),
        recorder(session, participant_key(session), *sink) {
    recorder.opened(nanoseconds(0), opening(session), "{}");
  }

  void answer(int trial) {
    recorder.presented(seconds(20 * trial), trial, 0);
    recorder.answered(seconds(20 * trial + 9),
                      {.trial = trial, .answer = ChoiceAnswer{2}, .confidence = {}});
  }

  std::unique_ptr<EventSink> sink;
  SessionRecorder recorder;
};

/// Limits the size of files while it exists, so that writing fails as on a full disk.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) : signal_(std::signal(SIGXFSZ, SIG_IGN)) {
    REQUIRE(::getrlimit(RLIMIT_FSIZE, &before_) == 0);
    const rlimit limit{.rlim_cur = bytes, .rlim_max = before_.rlim_max};
    REQUIRE(::setrlimit(RLIMIT_FSIZE, &limit) == 0);
  }
  ~FileSizeLimit() {
    ::setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, signal_);
  }
  FileSizeLimit(const FileSizeLimit&) = delete;
  FileSizeLimit& operator=(const FileSizeLimit&) = delete;

 private:
  rlimit before_{};
  void (*signal_)(int);
};

}  // namespace

TEST_CASE("a head file returns the last record, and counts writes") {
  const TempFolder folder;
  const HeadFile file(folder.path() / "study.db.head");
  REQUIRE_FALSE(file.read(known_signers()));
  file.update(station_signer(), [](HeadRecord& record) {
    REQUIRE(record == HeadRecord{});
    record = some_record();
    record.count = 99;
  });
  REQUIRE(file.read(known_signers()) == some_record());
  for (std::int64_t writes = 2; writes <= 5; ++writes) {
    file.update(station_signer(), count_one_more);
    REQUIRE(file.read(known_signers()) == after(writes));
  }
  REQUIRE(std::distance(std::filesystem::directory_iterator(folder.path()),
                        std::filesystem::directory_iterator()) == 1);
}

TEST_CASE("a head file is text of two copies of one size, each an object and its signature") {
  const WrittenHead head;
  const std::string bytes = head.bytes();
  REQUIRE(bytes.size() == 2 * kSlot);
  REQUIRE(contains(bytes.substr(0, kSlot), R"({"acknowledged":76,"also":"/media/lab disk",)"));
  REQUIRE(contains(bytes.substr(kSlot), R"({"acknowledged":75,"also":"/media/lab disk",)"));
  for (const std::string& slot : {bytes.substr(0, kSlot), bytes.substr(kSlot)}) {
    const std::size_t end = slot.find('\n');
    const std::string text = slot.substr(0, end);
    const auto signature = from_hex(slot.substr(end + 1, 128)).value();
    const std::string statement = "touchtrial head file 1\n" + text;
    REQUIRE(is_signed_by(station_signer().public_half(), bytes_of(statement), signature));
    REQUIRE(slot.back() == '\n');
    REQUIRE(slot.find_first_not_of(' ', end + 130) == kSlot - 1);
  }
}

TEST_CASE("a head file keeps the newest open sessions, whatever their numbers and lengths") {
  const TempFolder folder;
  const HeadFile file(folder.path() / "study.db.head");
  constexpr int kLast = std::numeric_limits<int>::max();
  constexpr auto kMost = static_cast<int>(kMaxHeadSessions);
  file.update(station_signer(), [](HeadRecord& record) {
    record = some_record();
    for (int i = 0; i < kMost; ++i) {
      record.sessions[kLast - i] = {.length = std::numeric_limits<std::int64_t>::max() - 1,
                                    .hash = digest_of(std::to_string(i))};
    }
  });
  const HeadRecord record = file.read(known_signers()).value();
  REQUIRE(record.sessions.size() == kMaxHeadSessions);
  REQUIRE(record.sessions.begin()->first == kLast - kMost + 1);
  REQUIRE(record.sessions.at(kLast).hash == digest_of("0"));
}

TEST_CASE("a record that no slot can hold is refused, and the one before stands") {
  const WrittenHead head;
  const std::string before = head.bytes();
  const auto refused_for = [&](const std::string& also) {
    return refusal_of([&] {
      head.file.update(station_signer(), [&](HeadRecord& record) { record.also = also; });
    });
  };
  REQUIRE_FALSE(refused_for(std::string(kSlot, 'x')).empty());
  REQUIRE(names(refused_for("/media/\xff"), "UTF-8"));
  REQUIRE(head.bytes() == before);
}

TEST_CASE("a change that throws leaves a head file as it was") {
  const WrittenHead head;
  const std::string before = head.bytes();
  REQUIRE_THROWS_AS(head.file.update(station_signer(),
                                     [](HeadRecord& record) {
                                       ++record.acknowledged;
                                       throw std::logic_error("no");
                                     }),
                    std::logic_error);
  REQUIRE(head.bytes() == before);
}

TEST_CASE("whatever byte of a head file is flipped, the other copy is read") {
  const WrittenHead head;
  std::string bytes = head.bytes();
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    const char whole = bytes[i];
    bytes[i] = static_cast<char>(static_cast<unsigned char>(whole) ^ (1U << (i % 8)));
    head.put(bytes);
    bytes[i] = whole;
    const HeadReading reading = head.file.reading(known_signers()).value();
    if (reading.record != after(i < kSlot ? 1 : 2) || reading.damage.empty()) {
      FAIL("byte " << i << ": " << reading.damage);
    }
  }
  head.put(bytes);
  REQUIRE(head.file.reading(known_signers())->damage.empty());
}

TEST_CASE("a head file both of whose copies have a flipped byte is refused with a remedy") {
  const WrittenHead head;
  const std::string whole = head.bytes();
  for (const std::size_t i : {0, 40, 700, 4000, 12287}) {
    std::string bytes = whole;
    bytes[i] = static_cast<char>(bytes[i] ^ 1);
    bytes[kSlot + i] = static_cast<char>(bytes[kSlot + i] ^ 1);
    head.put(bytes);
    const std::string line = head.refusal();
    REQUIRE(contains(line, head.file.path().string()));
    REQUIRE(refusal_of([&] { head.file.update(station_signer(), count_one_more); }) == line);
    REQUIRE(head.bytes() == bytes);
  }
}

TEST_CASE("a write that breaks off at any byte leaves the old record or the new one") {
  const WrittenHead head;
  const std::string before = head.bytes();
  head.file.update(station_signer(), count_one_more);
  const std::string written = head.bytes();
  REQUIRE(written.substr(0, kSlot) == before.substr(0, kSlot));
  std::size_t first_new = 0;
  for (std::size_t length = 0; length <= kSlot; ++length) {
    const std::string torn = written.substr(0, kSlot + length) + before.substr(kSlot + length);
    head.put(torn);
    const HeadRecord record = head.read().value();
    if (record == after(3) && first_new == 0) first_new = length;
    if (record != after(torn == written ? 3 : 2)) FAIL("torn after " << length << " bytes");
  }
  REQUIRE(first_new > 128);
}

TEST_CASE("after a torn write a head file continues from its complete copy") {
  const WrittenHead head;
  std::string bytes = head.bytes();
  bytes.replace(kSlot, 100, 100, 'x');
  head.put(bytes);
  REQUIRE_FALSE(head.file.reading(known_signers())->damage.empty());
  head.file.update(station_signer(), count_one_more);
  REQUIRE(head.read() == after(3));
  REQUIRE(head.file.reading(known_signers())->damage.empty());
  REQUIRE(head.bytes().substr(0, kSlot) == bytes.substr(0, kSlot));
}

TEST_CASE("a head file of another length is read if a copy is whole, and mended by a write") {
  const WrittenHead head;
  const std::string whole = head.bytes();
  for (const std::size_t length : {kSlot, kSlot + 1, 2 * kSlot - 1}) {
    head.put(whole.substr(0, length));
    REQUIRE(head.read() == after(2));
  }
  for (const std::size_t length : {std::size_t{0}, std::size_t{1}, kSlot - 1}) {
    head.put(whole.substr(0, length));
    REQUIRE_FALSE(head.refusal().empty());
  }
  head.put(whole + "x");
  REQUIRE_FALSE(head.file.reading(known_signers())->damage.empty());
  REQUIRE(::truncate(head.file.path().c_str(), off_t{1} << 40U) == 0);
  REQUIRE(head.read() == after(2));
  head.file.update(station_signer(), count_one_more);
  REQUIRE(head.bytes().size() == 2 * kSlot);
  REQUIRE(head.read() == after(3));
}

TEST_CASE("an invalid head file is refused with one line") {
  const WrittenHead head;
  const std::filesystem::path& path = head.file.path();
  for (const std::string& content :
       {std::string(5 * kSlot, '\0'), std::string(2 * kSlot, '{'), std::string(2 * kSlot, '\n'),
        std::string("SQLite format 3")}) {
    head.put(content);
    REQUIRE_FALSE(head.refusal().empty());
  }
  std::filesystem::remove(path);
  std::filesystem::create_directory(path);
  REQUIRE_FALSE(head.refusal().empty());
  std::filesystem::remove(path);
  REQUIRE(::mkfifo(path.c_str(), 0600) == 0);
  REQUIRE_FALSE(head.refusal().empty());
  std::filesystem::remove(path);
  std::filesystem::create_symlink(path.string() + ".nothing", path);
  REQUIRE(refuses([&] { head.file.update(station_signer(), count_one_more); }));
}

TEST_CASE("only the study's keys sign a head file, and only as a head file") {
  const WrittenHead head;
  const Signer stranger(digest_of("another station's secret"));
  const std::vector<PublicKey> strangers = {stranger.public_half()};
  REQUIRE_FALSE(unreadable([&] { (void)head.file.read(strangers); }).empty());
  REQUIRE_FALSE(refusal_of([&] { head.file.update(stranger, count_one_more); }).empty());
  REQUIRE(head.read() == after(2));

  // The investigator's decisions go into the same file, and the station goes on after them.
  head.file.update(investigator_signer(), count_one_more, known_signers());
  head.file.update(station_signer(), count_one_more, known_signers());
  REQUIRE(head.read() == after(4));

  // The same words, signed as something else or of another version.
  const auto forged = [&](const std::string& context, const std::string& text) {
    const std::string statement = context + text;
    std::string slot = text + "\n" + to_hex(station_signer().sign(bytes_of(statement))) + "\n";
    slot.append(kSlot - 1 - slot.size(), ' ');
    slot += '\n';
    head.put(slot + slot);
    return head.refusal();
  };
  const std::string slot = head.bytes().substr(0, kSlot);
  const std::string text = slot.substr(0, slot.find('\n'));
  REQUIRE(forged("touchtrial head file 1\n", text).empty());
  REQUIRE_FALSE(forged("", text).empty());
  REQUIRE_FALSE(forged("touchtrial head file 2\n", text).empty());
  std::string newer = text;
  newer.replace(newer.find(R"("version":1)"), 11, R"("version":2)");
  REQUIRE(contains(forged("touchtrial head file 1\n", newer), "/version"));
  for (const std::string bad : {"", "[]", "{}", "null", "{\"count\":1e400}"}) {
    REQUIRE_FALSE(forged("touchtrial head file 1\n", bad).empty());
  }
}

TEST_CASE("a head file that several threads at once update loses nothing") {
  const TempFolder folder;
  const HeadFile file(folder.path() / "study.db.head");
  constexpr int kUpdates = 200;
  const auto answer = [&](int session) {
    for (int i = 1; i <= kUpdates; ++i) {
      file.update(station_signer(), [&](HeadRecord& record) {
        ++record.acknowledged;
        record.advance_session(session, {.length = i, .hash = digest_of(std::to_string(i))});
      });
    }
  };
  std::string failed;
  std::thread other([&] {
    try {
      answer(2);
    } catch (const std::exception& error) {
      failed = error.what();
    }
  });
  answer(1);
  other.join();
  REQUIRE(failed.empty());
  const HeadRecord record = file.read(known_signers()).value();
  REQUIRE(record.acknowledged == 2 * kUpdates);
  REQUIRE(record.count == 2 * kUpdates);
  for (const int session : {1, 2}) REQUIRE(record.sessions.at(session).length == kUpdates);
}

TEST_CASE("a head file that another program keeps locked is refused after a while") {
  const WrittenHead head;
  const HeadFile file(head.file.path(), milliseconds(1));
  const int held = ::open(file.path().c_str(), O_RDONLY | O_CLOEXEC);
  REQUIRE(held >= 0);
  REQUIRE(::flock(held, LOCK_EX) == 0);
  const std::string line = refusal_of([&] { file.update(station_signer(), count_one_more); });
  REQUIRE_FALSE(line.empty());
  REQUIRE_FALSE(unreadable([&] { (void)file.read(known_signers()); }).empty());
  ::close(held);
  file.update(station_signer(), count_one_more);
  REQUIRE(head.read() == after(3));
}

TEST_CASE("a head file that cannot be written stops the acknowledgement, and keeps its record") {
  const WrittenHead head;
  const std::string before = head.bytes();
  for (const rlim_t limit : {rlim_t{100}, rlim_t{kSlot}, rlim_t{kSlot + 100}}) {
    {
      const FileSizeLimit full(limit);
      const std::string line =
          refusal_of([&] { head.file.update(station_signer(), count_one_more); });
      REQUIRE(contains(line, head.file.path().string()));
      REQUIRE(contains(line, "(File too large)"));
    }
    REQUIRE(head.bytes() == before);
    REQUIRE(head.read() == after(2));
  }
  {
    const FileSizeLimit full(100);
    const HeadFile unborn(head.folder.path() / "other.head");
    REQUIRE_FALSE(
        refusal_of([&] { unborn.update(station_signer(), becomes(some_record())); }).empty());
    REQUIRE_FALSE(unborn.read(known_signers()));
  }
  head.file.update(station_signer(), count_one_more);
  REQUIRE(head.read() == after(3));
}

TEST_CASE("a record notes longer chains and more answers, and forgets none") {
  HeadRecord record = some_record();
  record.advance_file({.length = 8, .hash = digest_of("older")});
  record.advance_session(3, {.length = 56, .hash = digest_of("older")});
  record.advance_answers(74);
  REQUIRE(record == some_record());
  record.advance_file({.length = 10, .hash = digest_of("newer")});
  record.advance_session(5, {.length = 1, .hash = digest_of("fifth")});
  record.advance_answers(76);
  REQUIRE(record.file.hash == digest_of("newer"));
  REQUIRE(record.sessions.at(5).length == 1);
  REQUIRE(record.acknowledged == 76);
}

TEST_CASE("two head files are both written, and found again by the one beside the database") {
  const TwoDisks at;
  const auto& [folder, database, disk] = at;
  {
    const HeadFiles files(database, known_signers(), disk);
    REQUIRE(files.paths() == std::vector{folder.path() / "study.db.head", disk / "study.db.head"});
    REQUIRE(files.read().empty());
    files.update(station_signer(), becomes(some_record()));
    files.update(station_signer(), count_one_more);
  }
  const HeadFiles files(database, known_signers());
  const std::vector<HeadReading> readings = files.read();
  REQUIRE(readings.size() == 2);
  for (const HeadReading& reading : readings) {
    REQUIRE(reading.record.acknowledged == 76);
    REQUIRE(reading.record.also == disk.string());
    REQUIRE(reading.damage.empty());
  }
  REQUIRE(HeadFiles(database, known_signers(), "").paths().size() == 1);
}

TEST_CASE("the second head file gives away that the first was rolled back") {
  const TwoDisks at;
  const HeadFiles files(at.database, known_signers(), at.disk);
  files.update(station_signer(), becomes(some_record()));
  const std::string old = text_of(read_file(files.paths()[0]));
  for (int i = 0; i < 6; ++i) files.update(station_signer(), count_one_more);
  std::ofstream(files.paths()[0], std::ios::binary | std::ios::trunc) << old;
  files.update(station_signer(), [](HeadRecord& record) { record.advance_answers(76); });
  const std::vector<HeadReading> readings = files.read();
  REQUIRE(readings.at(0).record.acknowledged == 76);
  REQUIRE(readings.at(1).record.acknowledged == 81);
}

TEST_CASE("a second head file that is missing is made with the record of the first") {
  const TwoDisks at;
  HeadFiles(at.database, known_signers(), "").update(station_signer(), becomes(some_record()));
  const HeadFiles files(at.database, known_signers(), at.disk);
  REQUIRE(files.read().size() == 1);
  files.update(station_signer(), count_one_more);
  const std::vector<HeadReading> readings = files.read();
  REQUIRE(readings.size() == 2);
  REQUIRE(readings[1].record.acknowledged == 76);
  REQUIRE(readings[1].record.sessions == some_record().sessions);
}

TEST_CASE("a second folder that cannot be reached is named, before a session and in it") {
  const TempFolder folder;
  const std::filesystem::path database = folder.path() / "study.db";
  const std::filesystem::path disk = folder.path() / "disk";
  const auto opened_with = [&](const std::filesystem::path& also) {
    return unreadable([&] { const HeadFiles files(database, known_signers(), also); });
  };
  REQUIRE(contains(opened_with(disk), disk.string()));
  std::ofstream(disk.string()) << "a file";
  REQUIRE(contains(opened_with(disk), disk.string()));
  std::filesystem::remove(disk);
  REQUIRE(contains(opened_with(folder.path()), folder.path().string()));

  std::filesystem::create_directory(disk);
  const HeadFiles files(database, known_signers(), disk);
  files.update(station_signer(), becomes(some_record()));
  std::filesystem::remove_all(disk);
  const std::string line = refusal_of([&] { files.update(station_signer(), count_one_more); });
  REQUIRE(contains(line, disk.string()));
  REQUIRE(contains(unreadable([&] { const HeadFiles again(database, known_signers()); }),
                   disk.string()));
}

TEST_CASE("two databases do not share a second head file") {
  const TwoDatabases at;
  const HeadFiles one(at.one, known_signers(), at.disk);
  const HeadFiles two(at.two, known_signers(), at.disk);
  one.update(station_signer(), becomes(some_record()));
  HeadRecord record = some_record();
  record.database = digest_of("another first event");
  HeadFiles(at.two, known_signers(), "").update(station_signer(), becomes(record));
  REQUIRE(refuses([&] { two.update(station_signer(), count_one_more); }));
  REQUIRE(one.read().at(1).record.acknowledged == 75);
}

TEST_CASE("one disk with heads of two studies whose databases have one name says whose it has") {
  const TwoDatabases at;
  HeadRecord record = some_record();
  record.station = "attic";
  const HeadFiles one(at.one, known_signers(), at.disk);
  one.update(station_signer(), becomes(record));
  const std::filesystem::path shared = at.disk / "study.db.head";
  const std::string before = text_of(read_file(shared));
  const Signer other(digest_of("another study's station"));
  const HeadFiles two(at.two, {other.public_half()}, at.disk);
  for (const std::string& line : {unreadable([&] { static_cast<void>(two.read()); }),
                                  refusal_of([&] { two.update(other, becomes(some_record())); })}) {
    INFO(line);
    REQUIRE(contains(line, shared.string()));
    REQUIRE(names_in_order(line, "attic " + commitment().study_id + " --heads"));
  }
  REQUIRE(text_of(read_file(shared)) == before);
}

TEST_CASE("a record of a database has its chains' ends, its open sessions and all answers") {
  StoredFixture study(2);  // each with two answers
  OpenSession third(*study.store, 3);
  third.answer(1);
  const HeadRecord record = record_of(*study.store);
  REQUIRE(record.study_id == commitment().study_id);
  REQUIRE(record.station == "only");
  REQUIRE(record.database == study.store->events(0).front().hash);
  REQUIRE(record.file == study.store->file_head());
  REQUIRE(record.sessions ==
          std::map<int, ChainHead>{{3, {.length = 3, .hash = third.recorder.head()}}});
  REQUIRE(study.store->answers() == 5);
  REQUIRE(record.acknowledged == 5);
  REQUIRE(record.count == 0);
}

TEST_CASE("events are found by their places") {
  const StoredFixture study(1);
  const std::vector<Event> events = study.store->events(1);
  REQUIRE(study.store->event_at(1, 2)->hash == events[2].hash);
  REQUIRE_FALSE(study.store->event_at(1, static_cast<std::int64_t>(events.size())));
  REQUIRE_FALSE(study.store->event_at(2, 0));
}

TEST_CASE("a database that is where its head file left it, or ahead of it, has lost nothing") {
  StoredFixture study(1);
  OpenSession second(*study.store, 2);
  second.answer(1);
  const HeadRecord record = record_of(*study.store);
  REQUIRE(losses(record, *study.store).empty());
  second.answer(2);
  REQUIRE(losses(record, *study.store).empty());
  second.recorder.closed(seconds(90), true);
  study.store->exclude(1, kUtc, "fell asleep");
  REQUIRE(losses(record, *study.store).empty());
  study.store->withdraw(2, kUtc, "asked to");
  REQUIRE(losses(record, *study.store).empty());
}

TEST_CASE("a lost write-ahead log is named by its session, with the answers in it") {
  StoredFixture study(1);
  const std::filesystem::path without_log = study.folder.path() / "copy.db";
  OpenSession second(*study.store, 2);
  second.answer(1);
  copy_database(study.path, without_log);
  for (int trial = 2; trial <= 7; ++trial) second.answer(trial);
  const HeadRecord record = record_of(*study.store);
  const StudyStore copy = StudyStore::open(without_log, StudyStore::Access::read_only);
  require_losses(losses(record, copy), {{2, "2 P2 3 15 6", 6}});
}

TEST_CASE("sessions dropped from the end of a database are named") {
  StoredFixture study(1);
  const std::filesystem::path old = study.folder.path() / "old.db";
  copy_database(study.path, old);
  OpenSession second(*study.store, 2);
  second.answer(1);
  const HeadRecord while_open = record_of(*study.store);
  second.recorder.closed(seconds(90), true);
  add(*study.store, 3);
  const HeadRecord record = record_of(*study.store);
  const StudyStore rolled_back = StudyStore::open(old, StudyStore::Access::read_only);
  require_losses(losses(while_open, rolled_back), {{0, "3 4"}, {2, "2 3 1", 1}});
  require_losses(losses(record, rolled_back), {{0, "3 7"}, {0, "3 2 5", 3}});
}

TEST_CASE("a database that was rolled back and written anew is named, though it is longer") {
  StoredFixture study(1);
  const std::filesystem::path old = study.folder.path() / "old.db";
  copy_database(study.path, old);
  OpenSession second(*study.store, 2);
  second.answer(1);
  study.store->note(1, kUtc, "", "a door slammed");
  const HeadRecord record = record_of(*study.store);

  StudyStore again = writable(old);
  again.note(1, kUtc, "", "nothing happened");
  OpenSession anew(again, 2);
  anew.recorder.add(seconds(1), EventKind::instructed, TextBody{.text = ""});
  anew.answer(1);
  anew.answer(2);
  require_losses(losses(record, again), {{0, "4"}, {2, "2 2 P2"}});
}

TEST_CASE("lost answers of two sessions are reported as one number") {
  StoredFixture study;
  OpenSession first(*study.store, 1);
  first.answer(1);
  OpenSession second(*study.store, 2);
  second.answer(1);
  const HeadRecord record = record_of(*study.store);
  tamper(study, "DELETE FROM events WHERE session > 0 AND sequence > 0");
  require_losses(losses(record, *study.store), {{1, "1 P1 1 3"}, {2, "2 P2 1 3"}, {0, "2 0 2", 2}});
}

TEST_CASE("another database under the same name is not accepted") {
  StoredFixture study(1);
  const HeadRecord record = record_of(*study.store);
  const TempFolder folder;
  const StudyStore anew = StudyStore::create(folder.path() / "study.db", commitment(),
                                             kUtc + seconds(1), investigator());
  require_losses(losses(record, anew), {{0, "", 2}});
}

TEST_CASE("a head that is read out is four groups of digits of the file chain's hash") {
  const HeadRecord record = some_record();
  const std::string digits = to_hex(record.file.hash);
  REQUIRE(head_digits(record) == digits.substr(0, 4) + " " + digits.substr(4, 4) + " " +
                                     digits.substr(8, 4) + " " + digits.substr(12, 4));
}
