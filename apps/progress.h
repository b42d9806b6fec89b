// A bar on the terminal for work that takes longer than a second.
#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>

namespace obscura::apps {

// Shows "[====>   ] 2/3 rendering  4.2 s" on standard error, if that is a terminal, from one second on; the line is
// gone when the object is.
class Progress {
 public:
  Progress(int steps, bool quiet);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void step(const char* what);  // the next step begins
  void at(double fraction);     // how much of it is done, 0 to 1, where that is known; from any thread
  void clear();                 // makes room for a line of text; the bar comes back
  void finish();                // clears the line; nothing is shown any more

 private:
  void run();
  void draw();

  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  int steps_, current_ = 0;
  std::string what_;
  double fraction_ = -1;  // negative: not known
  bool done_ = false, drawn_ = false;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::thread thread_;  // not started where nothing is to be shown
};

}  // namespace obscura::apps
