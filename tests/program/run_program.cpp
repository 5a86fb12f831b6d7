#include "tests/program/run_program.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <fstream>
#include <sstream>

namespace limn::test {
namespace {

namespace fs = std::filesystem;

std::string readAll(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream all;
  all << file.rdbuf();
  return all.str();
}

fs::path newDirectory() {
  static std::atomic<int> count{0};
  fs::path path =
      fs::temp_directory_path() / ("limn-test-" + std::to_string(::getpid()) + "-" + std::to_string(++count));
  fs::create_directories(path);
  return path;
}

void redirect(const fs::path& file, int flags, int descriptor) {
  const int opened = ::open(file.c_str(), flags, 0600);
  if (opened < 0 || ::dup2(opened, descriptor) < 0) ::_exit(126);
}

double seconds(const timeval& time) {
  return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

}  // namespace

Running::Running(const fs::path& directory, const std::vector<std::string>& arguments,
                 const std::string& input, unsigned long fileSizeLimit)
    : streams_(newDirectory()) {
  std::ofstream(streams_ / "in", std::ios::binary) << input;
  std::vector<const char*> words = {LIMN_PROGRAM};
  for (const std::string& argument : arguments) words.push_back(argument.c_str());
  words.push_back(nullptr);
  process_ = ::fork();
  if (process_ != 0) return;
  if (fileSizeLimit > 0) {
    ::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{fileSizeLimit, fileSizeLimit};
    ::setrlimit(RLIMIT_FSIZE, &limit);
  }
  redirect(streams_ / "in", O_RDONLY, STDIN_FILENO);
  redirect(streams_ / "out", O_WRONLY | O_CREAT, STDOUT_FILENO);
  redirect(streams_ / "err", O_WRONLY | O_CREAT, STDERR_FILENO);
  if (::chdir(directory.c_str()) != 0) ::_exit(126);
  ::execv(LIMN_PROGRAM, const_cast<char* const*>(words.data()));
  ::_exit(127);
}

Running::~Running() {
  if (process_ > 0) {
    ::kill(process_, SIGKILL);
    ::waitpid(process_, nullptr, 0);
  }
  std::error_code error;
  fs::remove_all(streams_, error);
}

void Running::signal(int number) const {
  ::kill(process_, number);
}

Result Running::wait() {
  int status = 0;
  rusage usage{};
  ::wait4(process_, &status, 0, &usage);
  process_ = -1;
  Result result;
  result.peakBytes = static_cast<std::size_t>(usage.ru_maxrss) << 10;
  result.processorSeconds = seconds(usage.ru_utime) + seconds(usage.ru_stime);
  result.status = WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
  result.out = readAll(streams_ / "out");
  result.err = readAll(streams_ / "err");
  return result;
}

ProgramTest::ProgramTest() : directory_(newDirectory()) {}

ProgramTest::~ProgramTest() {
  std::error_code error;
  fs::remove_all(directory_, error);
}

Result ProgramTest::limn(const std::vector<std::string>& arguments, const std::string& input) const {
  return Running(directory_, arguments, input).wait();
}

std::string ProgramTest::contents(const std::string& name) const {
  return readAll(path(name));
}

void ProgramTest::write(const std::string& name, const std::string& bytes) const {
  std::ofstream(path(name), std::ios::binary | std::ios::trunc) << bytes;
}

std::vector<std::string> ProgramTest::names(const std::string& folder) const {
  std::vector<std::string> all;
  if (!fs::exists(path(folder))) return all;
  for (const fs::directory_entry& entry : fs::directory_iterator(path(folder)))
    all.push_back(entry.path().filename().string());
  std::sort(all.begin(), all.end());
  return all;
}

std::vector<std::string> operator+(std::vector<std::string> words, const std::vector<std::string>& more) {
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

}  // namespace limn::test
