"""`cuscus why` explains every frame of a run, and links.csv counts what it lists.

Two nodes that hear each other send 100 group frames of 1000 B at once every 100 ms, which at 6 Mb/s
take 1.4 ms each: both mostly have one waiting, and more than their queues of 60 hold, however late
the host lets them send. Of every few frames, two begin in the same slot. Then each of the two
transmits while the other's frame arrives, and a third node between them, which hears both equally
loud, decodes neither. A fourth is 4 km away: 16 dBm less 112 dB of free space are below the -82 dBm
at which preambles are detected.
"""

import csv
import io
import sys
import unittest

from cuscus_run import SOURCE, Run, cuscus

SENDER = SOURCE / "tests" / "e2e" / "steady_sender.py"


def scenario(record):
    def node(name, x_m, *command):
        return {"name": name, "vehicle": {"model": "fixed"},
                "start": {"layout": "list", "positions": [[f"{x_m} m", "0 m", "10 m"]]},
                **({"command": list(command)} if command else {})}
    flood = (sys.executable, str(SENDER), "{broadcast}", "1000", "100", "100")
    return {"name": "why", "duration": "8 s", "ground_station": {"enabled": False},
            "radio": {"data_rate": "6 Mb/s", "group_rate": "6 Mb/s", "queue": {"frames": 60},
                      "propagation": {"model": "friis"}},
            "fleet": [node("left", 0, *flood), node("right", 60, *flood), node("between", 30),
                      node("far", 4000)],
            "record": {"receptions": record}}


def rows(text):
    return list(csv.DictReader(io.StringIO(text)))


class Why(unittest.TestCase):
    def explained(self, run, sender, receiver, *options):
        answer = cuscus("why", run.results, sender, receiver, "--csv", *options)
        self.assertEqual(answer.returncode, 0, answer.stderr)
        return rows(answer.stdout)

    def test_every_frame_has_its_one_cause(self):
        with Run(scenario(True), "--no-page") as run:
            self.assertIn(run.wait(), (0, 3), run.stderr)
            links = {(row["sender"], row["receiver"]): row
                     for row in rows((run.results / "links.csv").read_text())}
            whole_run = ("--at", "0s", "--for", "100s")
            for receiver, cause, interferer in (("right0", "half_duplex", None),
                                                ("between0", "collision", "right0"),
                                                ("far0", "below_detection", None)):
                with self.subTest(receiver=receiver):
                    frames = self.explained(run, "left0", receiver, *whole_run)
                    lost = [frame for frame in frames if frame["cause"] == cause]
                    self.assertGreater(len(lost), 5)
                    if interferer:
                        self.assertEqual({frame["interferer"] for frame in lost}, {interferer})
                    counted = links["left0", receiver]
                    self.assertEqual(int(counted["lost_" + cause]), len(lost))
                    received = sum(frame["cause"] == "received" for frame in frames)
                    self.assertEqual(int(counted["received"]), received)
                    for frame in frames:
                        if frame["cause"] != "queue_full":
                            self.check_budget(frame)
            given_up = [frame for frame in self.explained(run, "left0", "right0", *whole_run)
                        if frame["cause"] == "queue_full"]
            self.assertEqual(int(links["left0", "(group)"]["dropped_queue_full"]), len(given_up))
            self.assertGreater(len(given_up), 0)
            self.check_table(run)
            self.check_mistakes(run)

    def check_budget(self, frame):
        terms = {key: float(frame[key]) for key in frame if key.endswith(("_db", "_dbm"))
                 and key != "sinr_db"}
        power = terms.pop("power_dbm")
        gains = sum(value for key, value in terms.items() if not key.endswith("_loss_db"))
        losses = sum(value for key, value in terms.items() if key.endswith("_loss_db"))
        self.assertAlmostEqual(power, gains - losses, delta=1e-3)

    def check_table(self, run):
        answer = cuscus("why", run.results, "left0", "between0", "--at", "6s", "--for", "1500 ms")
        self.assertEqual(answer.returncode, 0)
        self.assertIn("lost: collision with right0", answer.stdout)
        # Free space at 30 m and 2.437 GHz: 69.73 dB.
        self.assertIn("= 16.00 sent +0.00 +0.00 antennas -69.73 path", answer.stdout)
        times = [float(line.split()[0]) for line in answer.stdout.splitlines() if " data " in line]
        self.assertTrue(times and 6.0 <= min(times) and max(times) < 7.5, times)

    def check_mistakes(self, run):
        for arguments, said in ((("left0", "uav9", "--at", "1s"), "there are: left0, right0"),
                                (("left0", "left0", "--at", "1s"), "sends itself nothing"),
                                (("left0", "far0", "--at", "60s"), "the run ended at 8.000 s"),
                                (("left0", "far0", "--at", "-1s"), "not a time of a run"),
                                (("left0", "far0", "--at", "soon"), "--at")):
            with self.subTest(arguments=arguments):
                answer = cuscus("why", run.results, *arguments)
                self.assertEqual(answer.returncode, 2, answer.stdout)
                self.assertIn(said, answer.stderr)
                self.assertEqual(len(answer.stderr.strip().splitlines()), 1, answer.stderr)

    def test_a_run_without_a_log_names_the_key_that_makes_one(self):
        with Run(scenario(False), "--no-page", "--duration", "1s") as run:
            self.assertIn(run.wait(), (0, 3), run.stderr)

            answer = cuscus("why", run.results, "left0", "right0", "--at", "1s")

            self.assertEqual(answer.returncode, 2)
            self.assertIn("record.receptions", answer.stderr)
            nowhere = cuscus("why", run.folder / "nowhere", "left0", "right0", "--at", "1s")
            self.assertEqual(nowhere.returncode, 2)
            self.assertIn("is not a run directory", nowhere.stderr)


if __name__ == "__main__":
    unittest.main()
