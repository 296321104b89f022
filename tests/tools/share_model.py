"""Predicts how long ranks are idle: the load of tests/tools/uneven.c and the rules of src/parallel/schedule.c, event by event.

    share_model.py [--message S] [--answer S] TILES SECONDS SLOWER RANKS...

--message is the time of a message one way, --answer what rank 0 takes for a request (one after another, beside its own tiles).
"""

import argparse
import heapq

BATCH_SECONDS, SECONDS_A_RANK = 0.1, 1e-4  # as in src/parallel/schedule.c
WAIT = -1


class Schedule:
    """Who gets how many tiles."""

    def __init__(self, tiles, ranks):
        self.next, self.end, self.ranks, self.rate = min(ranks, tiles), tiles, ranks, 0.0
        self.seconds = [0.0] * ranks

    def note(self, rank, seconds):
        if seconds > 0:
            self.rate += 1 / seconds - (1 / self.seconds[rank] if self.seconds[rank] else 0)
            self.seconds[rank] = seconds

    def grant(self, rank, early):
        left, seconds, tiles = self.end - self.next, self.seconds[rank], 1.0
        if seconds > 0:
            rest = left / max(self.rate, 1 / seconds)
            if early and rest < 2 * seconds:
                return self.next, 0
            tiles = min(rest / 2, max(BATCH_SECONDS, SECONDS_A_RANK * self.ranks)) / seconds
        first, n = self.next, min(left, max(1, int(tiles)))
        self.next += n
        return first, n


class Rank:
    """What a rank has in hand."""

    def __init__(self, number, tiles):
        self.number, self.first, self.n, self.more = number, number, int(number < tiles), True
        self.busy, self.done, self.free, self.answer = 0.0, 0, 0.0, None  # answer: (time, first, n, more)


def simulate(tiles, shortest, slower, ranks, message, answer):
    """Seconds of the whole, and the share in which ranks were idle."""
    def seconds_of(tile, rank):
        return (shortest * (5 if 0.4 <= tile / tiles < 0.6 else 1) * (20 if 0.6180339887498949 * tile % 1 < 0.02 else 1)
                * (slower if rank == ranks - 1 > 0 else 1))

    schedule, team, desk, queue = Schedule(tiles, ranks), [Rank(i, tiles) for i in range(ranks)], 0.0, []

    def ask(rank, time, early):
        nonlocal desk
        desk = max(desk, time + message) + answer
        schedule.note(rank.number, rank.busy / rank.done if rank.done else 0)
        first, n = schedule.grant(rank.number, early)
        rank.answer = desk + message, first, n, schedule.next < schedule.end

    def take(rank, time):
        """The next tile (None: no more); WAIT until the time returned where the answer is not there yet."""
        if rank.number == 0:
            schedule.note(0, rank.busy / rank.done if rank.done else 0)
            if not rank.n and schedule.next < schedule.end:
                rank.first, rank.n, schedule.next = schedule.next, 1, schedule.next + 1
        while rank.number and not rank.n and rank.more:
            if not rank.answer:
                ask(rank, time, False)
            if rank.answer[0] > time:
                return rank.answer[0], WAIT
            (_, rank.first, rank.n, rank.more), rank.answer = rank.answer, None
        if not rank.n:
            return time, None
        rank.first, rank.n = rank.first + 1, rank.n - 1
        if rank.number and not rank.n and rank.more and rank.done:
            ask(rank, time, True)
        return time, rank.first - 1

    for rank in team:
        heapq.heappush(queue, (0.0, rank.number))
    end = 0.0
    while queue:
        time, number = heapq.heappop(queue)
        begins, tile = take(team[number], time)
        end = max(end, begins)
        if tile == WAIT:
            heapq.heappush(queue, (begins, number))
        elif tile is not None:
            spent = seconds_of(tile, number)
            team[number].busy += spent
            team[number].done += 1
            heapq.heappush(queue, (begins + spent, number))
    return end, 1 - sum(rank.busy for rank in team) / (end * ranks)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--message", type=float, default=1e-3)
    parser.add_argument("--answer", type=float, default=1e-5)
    parser.add_argument("tiles", type=int)
    parser.add_argument("seconds", type=float)
    parser.add_argument("slower", type=float)
    parser.add_argument("ranks", type=int, nargs="+")
    o = parser.parse_args()
    for ranks in o.ranks:
        end, idle = simulate(o.tiles, o.seconds, o.slower, ranks, o.message, o.answer)
        print(f"{ranks} ranks: {end:.2f} s, idle {idle:.1%}", flush=True)


if __name__ == "__main__":
    main()
