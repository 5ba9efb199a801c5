#include "support/postgres_server.hpp"

#include <algorithm>
#include <chrono>
#include <csignal>
#include <fstream>
#include <iterator>
#include <memory>
#include <sstream>
#include <stdexcept>
#include <thread>

#include <fcntl.h>
#include <grp.h>
#include <libpq-fe.h>
#include <pwd.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

namespace touchtrial::testing {
namespace {

namespace fs = std::filesystem;

/// For a loaded machine; a broken server ends and is detected at once.
constexpr std::chrono::minutes kTimeout{2};
constexpr std::chrono::milliseconds kPollInterval{10};

/// The folder with initdb and postgres of the newest installed version.
fs::path find_programs() {
  std::vector<std::pair<int, fs::path>> found;
  std::error_code none;
  for (const auto& version : fs::directory_iterator("/usr/lib/postgresql", none)) {
    if (!fs::exists(version.path() / "bin" / "initdb")) continue;
    found.emplace_back(std::atoi(version.path().filename().c_str()), version.path() / "bin");
  }
  if (found.empty()) {
    throw std::runtime_error(
        "PostgreSQL is not installed, which these tests need; run scripts/install-dependencies "
        "tests");
  }
  return std::max_element(found.begin(), found.end())->second;
}

/// The user who runs the server if we are root; else null.
const passwd* server_user() {
  if (geteuid() != 0) return nullptr;
  const passwd* const user = getpwnam("postgres");
  if (user == nullptr) throw std::runtime_error("there is no user postgres to run the server");
  return user;
}

void set_owner(const fs::path& path, const passwd* user) {
  if (user != nullptr && chown(path.c_str(), user->pw_uid, user->pw_gid) != 0) {
    throw std::runtime_error("cannot make the user postgres the owner of " + path.string());
  }
}

std::string text_of(const fs::path& path) {
  std::ifstream file(path);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

/// Runs in the child.
[[noreturn]] void exec_server(std::vector<char*>& arguments, const passwd* user, int log) {
  if (user != nullptr && (setgroups(0, nullptr) != 0 || setgid(user->pw_gid) != 0 ||
                          setuid(user->pw_uid) != 0 || chdir("/") != 0)) {
    _exit(126);
  }
  // The server must not outlive the tests, even if they are killed.
  prctl(PR_SET_PDEATHSIG, SIGQUIT);
  dup2(log, STDOUT_FILENO);
  dup2(log, STDERR_FILENO);
  execv(arguments.front(), arguments.data());
  _exit(127);
}

std::vector<pid_t> children_of(pid_t parent) {
  const std::string id = std::to_string(parent);
  std::istringstream list(text_of("/proc/" + id + "/task/" + id + "/children"));
  return {std::istream_iterator<pid_t>(list), std::istream_iterator<pid_t>()};
}

using Connection = std::unique_ptr<PGconn, decltype(&PQfinish)>;
using Result = std::unique_ptr<PGresult, decltype(&PQclear)>;

}  // namespace

PostgresServer::PostgresServer(Writes writes) : writes_(writes), programs_(find_programs()) {
  set_owner(folder_.path(), server_user());
  for (const fs::path& folder : {folder_.path() / "data", socket_folder()}) {
    fs::create_directory(folder);
    fs::permissions(folder, fs::perms::owner_all);
    set_owner(folder, server_user());
  }
  initialise();
  start();
}

PostgresServer::~PostgresServer() {
  if (process_ > 0) kill();
}

void PostgresServer::initialise() const {
  run({(programs_ / "initdb").string(), "--no-sync", "--pgdata", (folder_.path() / "data").string(),
       "--auth=trust", "--username", kAdministrator, "--encoding=UTF8", "--locale=C"});
}

pid_t PostgresServer::launch(const std::vector<std::string>& arguments) const {
  std::vector<std::string> argument_copy = arguments;
  std::vector<char*> pointers;
  for (std::string& argument : argument_copy) pointers.push_back(argument.data());
  pointers.push_back(nullptr);
  const passwd* const user = server_user();
  const int log =
      open((folder_.path() / "log").c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0600);
  const pid_t process = fork();
  if (process == 0) exec_server(pointers, user, log);
  close(log);
  return process;
}

void PostgresServer::run(const std::vector<std::string>& arguments) const {
  int status = 0;
  if (waitpid(launch(arguments), &status, 0) < 0 || status != 0) {
    throw std::runtime_error(arguments.front() + " failed: " + text_of(folder_.path() / "log"));
  }
}

bool PostgresServer::accepts_connections() const {
  const std::string where = "host=" + socket_folder().string() + " dbname=postgres user=postgres";
  const Connection connection(PQconnectdb(where.c_str()), PQfinish);
  return PQstatus(connection.get()) == CONNECTION_OK;
}

void PostgresServer::start() {
  const std::string fsync = writes_ == Writes::safe ? "fsync=on" : "fsync=off";
  process_ = launch({(programs_ / "postgres").string(), "-D", (folder_.path() / "data").string(),
                     "-k", socket_folder().string(), "-c", "listen_addresses=", "-c", fsync, "-c",
                     "max_connections=40", "-c", "shared_buffers=16MB"});
  const auto until = std::chrono::steady_clock::now() + kTimeout;
  while (!accepts_connections()) {
    const bool ended = waitpid(process_, nullptr, WNOHANG) != 0;
    if (ended || std::chrono::steady_clock::now() > until) {
      if (ended) process_ = -1;
      throw std::runtime_error("PostgreSQL does not start: " + text_of(folder_.path() / "log"));
    }
    std::this_thread::sleep_for(kPollInterval);
  }
}

void PostgresServer::kill() {
  // A stopped server starts no new processes while its children die.
  ::kill(process_, SIGSTOP);
  waitpid(process_, nullptr, WUNTRACED);
  const std::vector<pid_t> children = children_of(process_);
  for (const pid_t child : children) ::kill(child, SIGKILL);
  ::kill(process_, SIGKILL);
  waitpid(process_, nullptr, 0);
  process_ = -1;
  // The children keep its shared memory, without which it cannot restart.
  const auto is_alive = [](pid_t child) {
    return ::kill(child, 0) == 0 &&
           text_of("/proc/" + std::to_string(child) + "/stat").find(") Z") == std::string::npos;
  };
  while (std::any_of(children.begin(), children.end(), is_alive)) {
    std::this_thread::sleep_for(kPollInterval);
  }
}

void PostgresServer::make_database(const std::string& name) {
  ask("postgres", "CREATE DATABASE " + name);
}

std::vector<std::string> PostgresServer::ask(const std::string& database,
                                             const std::string& sql) const {
  const Connection connection(PQconnectdb(url(database).c_str()), PQfinish);
  const Result result(PQexec(connection.get(), sql.c_str()), PQclear);
  const ExecStatusType status = PQresultStatus(result.get());
  if (status != PGRES_TUPLES_OK && status != PGRES_COMMAND_OK) {
    throw std::runtime_error(sql + ": " + PQerrorMessage(connection.get()));
  }
  std::vector<std::string> answers;
  for (int row = 0; row < PQntuples(result.get()); ++row) {
    answers.emplace_back(PQgetvalue(result.get(), row, 0));
  }
  return answers;
}

std::string PostgresServer::url(const std::string& database, const std::string& user) const {
  return "postgresql:///" + database + "?host=" + socket_folder().string() + "&user=" + user;
}

}  // namespace touchtrial::testing
