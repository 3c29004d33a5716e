// SPDX-License-Identifier: MIT
#include "server/http/edge.h"

#include <algorithm>
#include <cerrno>

#include <fcntl.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <pthread.h>
#include <sys/epoll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <unistd.h>

namespace penumbra {
namespace {

using std::chrono::milliseconds;

constexpr std::size_t kBlockBytes = 64u << 10;
constexpr int kBlocksInTurn = 4;     // read from one connection before the others have their turn
constexpr int kAcceptedInTurn = 64;
constexpr int kEventsBetweenAccepts = 16;  // who comes newly, a probe perhaps, does not wait for a turn of all others
// A client that is refused in the middle of its body reads the answer only when it stops sending; and closing with something unread
// would destroy the answer on its way (RST).
constexpr milliseconds kLingerTime{2000};
// One that was too slow, or was idle, gets little more.
constexpr milliseconds kShortLinger{200};
constexpr std::size_t kMostLingering = 256;
// Connections beyond the limit that are told so; still more are closed without a word.
constexpr std::size_t kMostRefusals = 64;
// A fresh connection may be this silent while others find no place.
constexpr milliseconds kPatienceWhenFull{1000};
// While the service ends: for requests that have begun, and for those that have been on their way.
constexpr milliseconds kDrainTime{3000};
constexpr milliseconds kFreshDrainTime{200};
constexpr milliseconds kAcceptPause{50};  // when there are no more file numbers
// File numbers for what is not in the number of connections: those that end, workers, fonts, shaders, the log.
constexpr std::size_t kOtherFiles = kMostLingering + kMostRefusals + 256;

constexpr std::string_view kContinue = "HTTP/1.1 100 Continue\r\n\r\n";

bool would_block(int error) { return error == EAGAIN || error == EWOULDBLOCK || error == EINTR; }

}  // namespace

Edge::Edge(const EdgeLimits& limits, Work work)
    : limits_(limits),
      work_(std::move(work)),
      most_connections_(limits.threads + limits.waiting_connections),
      held_(limits.held_bytes),
      block_(kBlockBytes),
      requests_("answers", limits.threads, [this](Connection& connection) { take_back(connection); }),
      side_("probes", 1, [this](Connection& connection) { take_back(connection); }) {}

Edge::~Edge() { stop(); }

void Edge::start(int listener) {
    most_connections_ = room_for_connections(most_connections_, kOtherFiles);
    listener_ = listener;
    ::fcntl(listener_, F_SETFL, ::fcntl(listener_, F_GETFL) | O_NONBLOCK);
    ::fcntl(listener_, F_SETFD, FD_CLOEXEC);
    epoll_ = ::epoll_create1(EPOLL_CLOEXEC);
    wake_ = ::eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC);
    for (int* file : {&listener_, &wake_}) {
        epoll_event event{};
        event.events = EPOLLIN;
        event.data.ptr = file;
        ::epoll_ctl(epoll_, EPOLL_CTL_ADD, *file, &event);
    }
    running_ = true;
    thread_ = std::thread([this] { run(); });
}

void Edge::serve(int socket) {
    std::promise<void> ended;
    {
        const std::lock_guard lock(mutex_);
        arrived_.emplace_back(socket, &ended);
    }
    wake();
    ended.get_future().wait();
}

void Edge::drain() {
    draining_ = true;
    wake();
}

void Edge::stop() {
    if (!thread_.joinable()) return;
    draining_ = true;
    stopping_ = true;
    wake();
    thread_.join();
    requests_.stop();
    side_.stop();
    ::close(epoll_);
    ::close(wake_);
}

void Edge::wake() const {
    const std::uint64_t one = 1;
    if (wake_ >= 0) [[maybe_unused]] const ssize_t written = ::write(wake_, &one, sizeof one);
}

int Edge::timeout() {
    Clock::time_point next = std::min(next_deadline_, accept_again_);
    if (requests_.nudge()) next = std::min(next, Clock::now() + Pool::kSoonDone);
    if (next == Clock::time_point::max()) return -1;
    return int(std::clamp<milliseconds::rep>(std::chrono::ceil<milliseconds>(next - Clock::now()).count(), 0, 60'000));
}

void Edge::run() {
    ::pthread_setname_np(::pthread_self(), "edge");
    epoll_event events[256];
    while (!(stopping_ && listener_ < 0 && connections_.empty())) {
        const int count = ::epoll_wait(epoll_, events, std::size(events), timeout());
        now_ = Clock::now();
        bool woken = false;
        for (int i = 0; i < count; ++i) {
            void* const what = events[i].data.ptr;
            if (i > 0 && i % kEventsBetweenAccepts == 0) accept_all();
            if (what == &listener_) {
                accept_all();
            } else if (what == &wake_) {
                woken = true;
            } else {
                on_event(*static_cast<Connection*>(what));
            }
        }
        if (woken) take_messages();
        if (draining_ && !drain_begun_) begin_drain();
        if (stopping_ && listener_ >= 0) {
            accept_all();  // those that have connected already are not reset
            ::close(listener_);
            listener_ = -1;
        }
        expire();
        ended_.clear();
    }
    running_ = false;
}

void Edge::take_messages() {
    std::uint64_t number = 0;
    [[maybe_unused]] const ssize_t count = ::read(wake_, &number, sizeof number);
    std::vector<Connection*> returned;
    std::vector<std::pair<int, std::promise<void>*>> arrived;
    {
        const std::lock_guard lock(mutex_);
        returned.swap(returned_);
        arrived.swap(arrived_);
    }
    for (Connection* connection : returned) {
        enter(*connection, State::writing, now_ + limits_.response_time);
        on_event(*connection);
    }
    for (const auto& [socket, ended] : arrived) accept(socket, ended);
}

// ---- arriving

void Edge::watch_listener(bool wanted) {
    epoll_event event{};
    event.events = wanted ? unsigned(EPOLLIN) : 0u;
    event.data.ptr = &listener_;
    ::epoll_ctl(epoll_, EPOLL_CTL_MOD, listener_, &event);
    accept_again_ = wanted ? Clock::time_point::max() : now_ + kAcceptPause;
}

void Edge::accept_all() {
    if (listener_ < 0 || (accept_again_ != Clock::time_point::max() && !stopping_)) return;
    for (int i = 0; i < kAcceptedInTurn || stopping_; ++i) {
        const int socket = ::accept4(listener_, nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC);
        if (socket >= 0) {
            const int yes = 1;
            ::setsockopt(socket, IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
            accept(socket, nullptr);
            continue;
        }
        if (errno == EMFILE || errno == ENFILE || errno == ENOBUFS || errno == ENOMEM) {
            watch_listener(false);  // they wait in the system's queue
            return;
        }
        if (errno != EINTR && errno != ECONNABORTED) return;
    }
}

void Edge::accept(int socket, std::promise<void>* ended) {
    const bool full = connections_.size() - lingering_ >= most_connections_ && !make_room();
    connections_.push_back(std::make_unique<Connection>(socket, limits_.request));
    Connection& connection = *connections_.back();
    connection.place = connections_.size() - 1;
    connection.start = now_;
    connection.ended = ended;
    if (!full) {
        connection.since = now_;
        enter(connection, State::reading, reading_deadline(connection, false));
        on_event(connection);  // its request has often come with it
        if (connection.state == State::reading) watch(connection, EPOLLIN);
    } else if (connections_.size() - lingering_ > most_connections_ + kMostRefusals) {
        close(connection);
    } else {
        connection.refusal = Fault::too_many_connections;
        hand_over(connection);
    }
}

// Ends the connection that has been idle for the longest time, else one that has never said anything.
bool Edge::make_room() {
    Connection* idle = nullptr;
    for (const auto& connection : connections_) {
        if (connection->state != State::reading || connection->reader.begun()) continue;
        if (connection->fresh && now_ - connection->since < kPatienceWhenFull) continue;
        if (!idle || std::pair(connection->fresh, connection->since) < std::pair(idle->fresh, idle->since)) idle = connection.get();
    }
    if (idle) linger(*idle, kShortLinger);
    return idle != nullptr;
}

// ---- states

void Edge::enter(Connection& connection, State state, Clock::time_point deadline) {
    if (state != connection.state) {
        lingering_ += std::size_t(state == State::lingering) - std::size_t(connection.state == State::lingering);
        connection.state = state;
    }
    connection.deadline = deadline;
    next_deadline_ = std::min(next_deadline_, deadline);
}

void Edge::watch(Connection& connection, unsigned events) {
    epoll_event event{};
    event.events = events;
    event.data.ptr = &connection;
    if (::epoll_ctl(epoll_, connection.watched ? EPOLL_CTL_MOD : EPOLL_CTL_ADD, connection.socket, &event) != 0) {
        close(connection);
        return;
    }
    connection.watched = true;
}

void Edge::ignore(Connection& connection) {
    if (connection.watched) ::epoll_ctl(epoll_, EPOLL_CTL_DEL, connection.socket, nullptr);
    connection.watched = false;
}

Edge::Clock::time_point Edge::reading_deadline(const Connection& connection, bool begun) const {
    const Clock::time_point from = begun ? connection.start : connection.since;
    const Clock::time_point end = from + (begun ? limits_.request_time : limits_.keep_alive);
    if (!draining_) return end;
    // What had been on its way gets its time, what comes later as well; who only kept a connection has none.
    const milliseconds rest = begun ? kDrainTime : connection.fresh ? kFreshDrainTime : milliseconds(0);
    return std::min(end, std::max(drain_start_, from) + rest);
}

void Edge::on_event(Connection& connection) {
    try {
        switch (connection.state) {
            case State::reading: receive(connection); break;
            case State::writing: write(connection); break;
            case State::lingering:
                for (int i = 0; i < kBlocksInTurn; ++i) {
                    const ssize_t count = ::recv(connection.socket, block_.data(), block_.size(), MSG_DONTWAIT);
                    if (count == 0 || (count < 0 && !would_block(errno))) {
                        close(connection);
                        return;
                    }
                    if (count < ssize_t(block_.size())) return;
                }
                break;
            case State::answering:
            case State::closed: break;  // since the same turn
        }
    } catch (const std::exception&) {  // no memory
        close(connection);
    }
}

// ---- reading

void Edge::receive(Connection& connection) {
    for (int i = 0; i < kBlocksInTurn && connection.state == State::reading; ++i) {
        const ssize_t count = ::recv(connection.socket, block_.data(), block_.size(), MSG_DONTWAIT);
        if (count < 0) {
            if (!would_block(errno)) close(connection);
            return;
        }
        if (count == 0) {
            if (!connection.reader.begun()) {
                close(connection);
                return;
            }
            connection.reader.end();
            hand_over(connection);
            return;
        }
        feed(connection, {block_.data(), std::size_t(count)});
        if (count < ssize_t(block_.size())) return;
    }
}

void Edge::feed(Connection& connection, std::string_view bytes) {
    RequestReader& reader = connection.reader;
    if (!reader.begun()) {
        connection.fresh = false;
        connection.start = connection.since = now_;
        enter(connection, State::reading, reading_deadline(connection, true));
    }
    while (!bytes.empty() && reader.state() != RequestReader::State::done) {
        bytes.remove_prefix(reader.take(bytes));
        if (reader.state() == RequestReader::State::asked && !ask(connection, !bytes.empty())) return;
    }
    connection.rest = bytes;
    count(connection);
    if (reader.state() == RequestReader::State::done) {
        hand_over(connection);
    } else if (held_.over()) {
        bound_held();
    }
}

// The head is there: what becomes of the body. False: the connection has ended.
bool Edge::ask(Connection& connection, bool more_is_there) {
    RequestReader& reader = connection.reader;
    const RequestHead head(reader.head());
    const Judgement judgement = work_.judge(head, reader);
    connection.probe = judgement.probe;
    connection.at_once = judgement.at_once;
    if (!judgement.wants_body) {
        reader.leave_body();
        return true;
    }
    reader.go_on();
    if (reader.state() != RequestReader::State::body || more_is_there || head.version != "HTTP/1.1") return true;
    const auto expected = head.values("Expect");
    if (expected.size() != 1 || !same_name(expected[0], "100-continue")) return true;
    if (::send(connection.socket, kContinue.data(), kContinue.size(), MSG_NOSIGNAL | MSG_DONTWAIT) == ssize_t(kContinue.size())) return true;
    close(connection);
    return false;
}

void Edge::count(Connection& connection) { held_.change(connection.held, connection.reader.held() + connection.rest.size()); }

// Who holds most is refused: not who came last, or a few that send much and slowly would keep all others out.
void Edge::bound_held() {
    while (held_.over()) {
        Connection* most = nullptr;
        for (const auto& connection : connections_) {
            if (connection->state == State::reading && (!most || connection->held > most->held)) most = connection.get();
        }
        if (!most || most->held == 0) return;
        most->reader.refuse(Fault::too_many_connections);
        count(*most);
        hand_over(*most);
    }
}

// ---- answering

void Edge::hand_over(Connection& connection) {
    ignore(connection);
    enter(connection, State::answering, Clock::time_point::max());
    if (connection.at_once && connection.reader.fault() == Fault::none && connection.rest.empty()) {
        connection.go_on = work_.answer(connection);
        enter(connection, State::writing, now_ + limits_.response_time);
        write(connection);
        return;
    }
    const bool to_side = connection.probe || connection.refusal != Fault::none || connection.reader.fault() != Fault::none;
    (to_side ? side_ : requests_).add(connection, connection.probe);
}

// On a thread of a pool.
void Edge::take_back(Connection& connection) {
    connection.go_on = work_.answer(connection);
    {
        const std::lock_guard lock(mutex_);
        returned_.push_back(&connection);
    }
    wake();
}

void Edge::write(Connection& connection) {
    for (std::string_view rest = connection.left(); !rest.empty(); rest = connection.left()) {
        const ssize_t count = ::send(connection.socket, rest.data(), rest.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
        if (count >= 0) {
            held_.has_sent(connection, std::size_t(count));
            continue;
        }
        would_block(errno) ? watch(connection, EPOLLOUT) : close(connection);
        return;
    }
    finish(connection);
}

// The answer has been sent.
void Edge::finish(Connection& connection) {
    ignore(connection);
    if (!connection.go_on) {
        const bool slow = connection.reader.fault() == Fault::timeout || connection.reader.fault() == Fault::stopping;
        linger(connection, slow ? kShortLinger : kLingerTime);
        return;
    }
    connection.reader = RequestReader(limits_.request);
    connection.probe = connection.at_once = false;
    connection.since = now_;
    const std::string rest = std::move(connection.rest);
    connection.rest = {};
    count(connection);
    enter(connection, State::reading, reading_deadline(connection, false));
    if (!rest.empty()) feed(connection, rest);
    if (connection.state == State::reading) watch(connection, EPOLLIN);
}

// Reads and forgets what the client still sends, so that closing does not destroy the answer.
void Edge::linger(Connection& connection, milliseconds time) {
    connection.rest = {};
    connection.reader = RequestReader(limits_.request);
    count(connection);
    ::shutdown(connection.socket, SHUT_WR);
    if (lingering_ >= kMostLingering) {
        const auto oldest = std::min_element(connections_.begin(), connections_.end(), [](const auto& a, const auto& b) {
            const bool first = a->state == State::lingering, second = b->state == State::lingering;
            return first != second ? first : a->since < b->since;
        });
        close(**oldest);
    }
    connection.since = now_;
    enter(connection, State::lingering, now_ + (stopping_ ? std::min(time, 2 * kShortLinger) : time));
    watch(connection, EPOLLIN);
}

void Edge::close(Connection& connection) {
    if (connection.state == State::closed) return;
    ignore(connection);
    enter(connection, State::closed, Clock::time_point::max());
    held_.change(connection.held, 0);
    held_.change(connection.held_unsent, 0);
    ::close(connection.socket);
    if (connection.ended) connection.ended->set_value();
    // It may have an event in this turn.
    const std::size_t place = connection.place;
    ended_.push_back(std::move(connections_[place]));
    if (place + 1 < connections_.size()) {
        connections_[place] = std::move(connections_.back());
        connections_[place]->place = place;
    }
    connections_.pop_back();
}

// ---- time

void Edge::expire() {
    if (now_ >= accept_again_ && listener_ >= 0) watch_listener(true);
    if (now_ < next_deadline_) return;
    next_deadline_ = Clock::time_point::max();
    std::vector<Connection*> late;
    for (const auto& connection : connections_) {
        if (connection->deadline <= now_) {
            late.push_back(connection.get());
        } else {
            next_deadline_ = std::min(next_deadline_, connection->deadline);
        }
    }
    for (Connection* connection : late) expire(*connection);
}

void Edge::expire(Connection& connection) {
    if (connection.state == State::reading && connection.reader.begun()) {
        const bool late = now_ - connection.start >= limits_.request_time;
        connection.reader.refuse(late ? Fault::timeout : Fault::stopping);
        hand_over(connection);
    } else if (connection.state == State::reading) {
        linger(connection, kShortLinger);
    } else if (connection.state == State::writing || connection.state == State::lingering) {
        close(connection);
    }
}

void Edge::begin_drain() {
    drain_begun_ = true;
    drain_start_ = now_;
    for (const auto& connection : connections_) {
        if (connection->state == State::reading) enter(*connection, State::reading, reading_deadline(*connection, connection->reader.begun()));
    }
}

}  // namespace penumbra
