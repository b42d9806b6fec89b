// Signals that end a program: its temporary files go first, and the exit code is 128 + the signal's number.
#pragma once

namespace obscura::apps {

// For SIGHUP, SIGINT, SIGQUIT, SIGTERM, SIGPIPE and SIGXCPU, unless they are ignored (nohup). SIGXFSZ is ignored from
// now on, so that a file beyond its limit is a failed write like any other. Call once, before any thread is started.
void endCleanlyOnSignals();

// While true, a signal also clears the terminal line on standard error.
void clearLineOnSignal(bool clear) noexcept;

}  // namespace obscura::apps
