// SPDX-License-Identifier: Apache-2.0
// What a progress report prints to a terminal, to a log and with --quiet.
#include "base/progress.h"

#include <gtest/gtest.h>
#include <poll.h>
#include <pty.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <string>
#include <thread>

#include "base/log.h"

namespace obscura {
namespace {

constexpr std::chrono::milliseconds LONGER_THAN_BAR_PERIOD{120};

// Standard error is a terminal while this lives; what was printed to it can be read.
class FakeTerminal {
  public:
    FakeTerminal() : saved_(::dup(STDERR_FILENO)) {
        int slave = -1;
        if (::openpty(&master_, &slave, nullptr, nullptr, nullptr) != 0) return;
        ::dup2(slave, STDERR_FILENO);
        ::close(slave);
    }
    ~FakeTerminal() {
        if (is_open()) ::close(master_);
        ::dup2(saved_, STDERR_FILENO);
        ::close(saved_);
    }
    // A system without /dev/pts (a bare chroot) has no terminals to fake.
    bool is_open() const { return master_ >= 0; }
    FakeTerminal(const FakeTerminal&) = delete;
    FakeTerminal& operator=(const FakeTerminal&) = delete;

    // What has been printed; the terminal hands it over in parts, and not at once.
    std::string read() const {
        constexpr int QUIET_MS = 200;
        std::string printed;
        std::array<char, 4096> buffer{};
        pollfd terminal{master_, POLLIN, 0};
        while (::poll(&terminal, 1, QUIET_MS) > 0) {
            const ssize_t count = ::read(master_, buffer.data(), buffer.size());
            if (count <= 0) break;
            printed.append(buffer.data(), static_cast<size_t>(count));
        }
        return printed;
    }

  private:
    int saved_;
    int master_ = -1;
};

TEST(Progress, OnATerminalDrawsABarAndThenTheTotal) {
    const FakeTerminal terminal;
    if (!terminal.is_open()) GTEST_SKIP() << "this system has no pseudo-terminals";
    Progress progress("render", "ray");
    progress.update(0.1, 100'000);  // too early for a bar
    std::this_thread::sleep_for(LONGER_THAN_BAR_PERIOD);
    progress.update(0.5, 1'000'000);
    const std::string bar = terminal.read();
    EXPECT_EQ(bar.find("100 k"), std::string::npos);
    EXPECT_NE(bar.find("render [############............]  50 %"), std::string::npos) << bar;
    EXPECT_NE(bar.find("rays/s"), std::string::npos) << bar;
    EXPECT_NE(bar.find(" left"), std::string::npos) << bar;
    EXPECT_EQ(bar.find('\n'), std::string::npos) << bar;
    EXPECT_LT(bar.size(), 80u) << bar;
    progress.finish(2'000'000);
    progress.finish(2'000'000);
    progress.update(0.9, 1);
    const std::string total = terminal.read();
    EXPECT_EQ(total.find("\r\x1b[Krender: 2.00 M rays in "), 0u) << total;
    EXPECT_EQ(std::count(total.begin(), total.end(), '\n'), 1) << total;
}

TEST(Progress, AnAbandonedBarEndsItsLine) {
    const FakeTerminal terminal;
    if (!terminal.is_open()) GTEST_SKIP() << "this system has no pseudo-terminals";
    {
        Progress progress("render", "ray");
        std::this_thread::sleep_for(LONGER_THAN_BAR_PERIOD);
        progress.update(0, 0);
    }
    const std::string printed = terminal.read();
    EXPECT_NE(printed.find("time left unknown"), std::string::npos) << printed;
    EXPECT_EQ(printed.back(), '\n');
}

TEST(Progress, InALogPrintsPlainLines) {
    testing::internal::CaptureStderr();
    {
        Progress progress("render", "ray");
        std::this_thread::sleep_for(LONGER_THAN_BAR_PERIOD);
        progress.update(0.5, 1'000'000);  // lines come every few seconds only
        progress.finish(2'000'000);
    }
    const std::string log = testing::internal::GetCapturedStderr();
    EXPECT_EQ(log.find("render: 2.00 M rays in "), 0u) << log;
    EXPECT_EQ(std::count(log.begin(), log.end(), '\n'), 1) << log;
    EXPECT_EQ(log.find('\x1b'), std::string::npos) << log;
}

TEST(Progress, OneUnitIsSingular) {
    testing::internal::CaptureStderr();
    Progress("render", "ray").finish(1);
    const std::string log = testing::internal::GetCapturedStderr();
    EXPECT_EQ(log.find("render: 1 ray in "), 0u) << log;
}

TEST(Progress, QuietPrintsNothing) {
    set_quiet(true);
    testing::internal::CaptureStderr();
    {
        Progress progress("render", "ray");
        progress.update(0.5, 1);
        progress.finish(2);
    }
    set_quiet(false);
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

}  // namespace
}  // namespace obscura
