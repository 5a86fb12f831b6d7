// Runs a fuzz target over the files of a folder, without libFuzzer: what was found once must not come back.
#include <algorithm>
#include <csignal>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include <unistd.h>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);
// NOLINTNEXTLINE(bugprone-reserved-identifier): the sanitizers' name
extern "C" void __sanitizer_set_death_callback(void (*callback)()) __attribute__((weak));

namespace {

std::string current;  // the file at fault, if this is the end

void nameTheFile() {
  const std::string line = "at fault: " + current + "\n";
  static_cast<void>(::write(STDERR_FILENO, line.data(), line.size()) == 0);
}

void onSignal(int signal) {
  nameTheFile();
  std::signal(signal, SIG_DFL);
  std::raise(signal);
}

void nameTheFileAtTheEnd() {
  if (__sanitizer_set_death_callback != nullptr) __sanitizer_set_death_callback(nameTheFile);
  std::signal(SIGABRT, onSignal);
  if (__sanitizer_set_death_callback != nullptr) return;
  for (const int signal : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGTERM}) std::signal(signal, onSignal);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fputs("usage: PROGRAM FOLDER\n", stderr);
    return 2;
  }
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(argv[1])) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  nameTheFileAtTheEnd();
  for (const std::filesystem::path& file : files) {
    current = file.string();
    std::ifstream stream(file, std::ios::binary);
    const std::vector<char> bytes{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
    LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
  }
  std::printf("%zu files\n", files.size());
  return files.empty() ? 1 : 0;
}
