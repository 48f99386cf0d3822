#include "place.hxx"
#include <algorithm>
#include <csignal>
#include <cstring>
#include <fcntl.h>
#include <unistd.h>

namespace occt {
namespace {

char entity[64];
std::filebuf* text = nullptr;
const char* text_path = nullptr;
char stack[1 << 16]; // that of the process may be what is used up

struct Message {
  char bytes[192];
  size_t length = 0;
  void add(const char* more) {
    const size_t count = std::min(std::strlen(more), sizeof bytes - length);
    std::memcpy(bytes + length, more, count);
    length += count;
  }
  void add(long number) {
    char digits[24];
    size_t at = sizeof digits - 1;
    digits[at] = 0;
    do digits[--at] = char('0' + number % 10);
    while (number /= 10);
    add(digits + at);
  }
};

// The line of the byte at which the text stands; by calls alone that a signal's handler may make.
long line() {
  const std::streamoff end = text->pubseekoff(0, std::ios::cur, std::ios::in);
  const int file = open(text_path, O_RDONLY | O_CLOEXEC);
  long lines = 1;
  char piece[4096];
  for (std::streamoff at = 0; file >= 0 && at < end;) {
    const ssize_t count = read(file, piece, std::min<std::streamoff>(sizeof piece, end - at));
    if (count <= 0) break;
    lines += std::count(piece, piece + count, '\n');
    at += count;
  }
  return lines;
}

// A crash's signal comes again once this has returned, and ends the process.
void told(int number) {
  Message message;
  message.add("sagitta-warning ");
  if (text) {
    message.add("line ");
    message.add(line());
  } else if (*entity) message.add(entity);
  else return;
  message.add(number == SIGXCPU ? ": OpenCASCADE was here when it was ended\n" : ": OpenCASCADE was here when it crashed\n");
  if (write(STDERR_FILENO, message.bytes, message.length) < 0) return; // nobody listens
}

} // namespace

void tell_crashes() {
  stack_t own{};
  own.ss_sp = stack;
  own.ss_size = sizeof stack;
  sigaltstack(&own, nullptr);
  struct sigaction action {};
  action.sa_handler = told;
  action.sa_flags = SA_RESETHAND | SA_ONSTACK;
  for (int number : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGXCPU}) sigaction(number, &action, nullptr);
}

void stand_at(rust::Str what) {
  const size_t count = std::min(what.size(), sizeof entity - 1);
  std::memcpy(entity, what.data(), count);
  entity[count] = 0;
}

Standing::Standing(std::filebuf* where, const char* path) {
  text = where;
  text_path = path;
}

Standing::~Standing() { text = nullptr; }

} // namespace occt
