#include "apps/limn/signals.h"

#include <pthread.h>
#include <unistd.h>

#include <csignal>
#include <string>
#include <thread>

#include "apps/limn/terminal.h"
#include "apps/scene/output_file.h"

namespace limn::program {
namespace {

bool isIgnored(int signal) {
  struct sigaction action {};
  return ::sigaction(signal, nullptr, &action) == 0 && action.sa_handler == SIG_IGN;
}

}  // namespace

void endOnSignals() {
  sigset_t set;
  sigemptyset(&set);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP})
    if (!isIgnored(signal)) sigaddset(&set, signal);
  if (::pthread_sigmask(SIG_BLOCK, &set, nullptr) != 0) return;
  std::thread([set] {
    int signal = 0;
    while (::sigwait(&set, &signal) != 0) {
    }
    scene::abandonWrites();
    printMessage("ended by signal " + std::to_string(signal) + "; no file is left half-written");
    ::_exit(128 + signal);
  }).detach();
}

}  // namespace limn::program
