"""A program on the SDK flies the UAV instead of cuscus-agent: the example of docs/sdk.md."""

import unittest

from cuscus_run import BIN, SOURCE, Run


class OwnAgent(unittest.TestCase):
    def test_the_example_hovers(self):
        scenario = {"name": "hover", "duration": "14 s",
                    "fleet": [{"name": "own", "count": 2, "agent": [str(BIN / "hover-agent")]},
                              {"name": "ours", "start": {"layout": "list",
                                                         "positions": [["9 m", "0 m", "0 m"]]}}]}
        with Run(scenario, "--no-page") as run:
            self.assertIn(run.wait(), (0, 3), run.stderr)
            last = {row["node"]: row for row in run.metrics()}
            for name in ("own0", "own1"):
                self.assertEqual(last[name]["flight_state"], "flying")
                self.assertAlmostEqual(last[name]["z_m"], 3.0, delta=0.3)
                self.assertEqual(run.node(name)["programs"][0]["exit_code"], 0)
            self.assertEqual(last["ours0"]["flight_state"], "stopped")

    def test_the_page_shows_what_is_flown(self):
        example = (SOURCE / "tests" / "e2e" / "hover_agent.cc").read_text()
        self.assertIn(example, (SOURCE / "docs" / "sdk.md").read_text())


if __name__ == "__main__":
    unittest.main()
