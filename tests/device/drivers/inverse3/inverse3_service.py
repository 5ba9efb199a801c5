#!/usr/bin/env python3
"""An emulated Inverse service with one Inverse3 and a hand on it.

Written from Haply's public documentation of the service (the simulation channel, sessions, device
configuration, events, HTTP; versions 3.1 and 3.5), and not from the driver that is tested with it.
What the documentation leaves open, and is assumed here, is marked "assumed".

Prints "ready PORT EVENTS_PORT HTTP_PORT" once it listens. Commands on standard input, one a line:
  explore           the hand comes down, strokes the plane, and lifts off
  calibrate         as if the grip had been put into the inkwell
  event JSON        sends an event to all listeners
  power on|off      the device's power supply
  hold JSON         the hand stays at [position, velocity], m and m/s, whatever the force
  report            prints a line of JSON on what has come in
Ends with its standard input. Time is counted in messages: the hand moves by one step for each.
"""

import argparse
import asyncio
import http
import json
import math
import random
import sys

import websockets

# The middle of the workspace in the frame of the arm's base, m. Assumed, after the positions in the
# documentation's examples: the presets that centre the frame hide it.
WORKSPACE_CENTRE_M = (0.0, -0.12, 0.15)


class Hand:
    """A point mass in a person's hand, in the frame of the middle of the workspace: m, kg, N.

    A spring and damper pull it along straight strokes; a constant force presses it down."""

    MASS_KG = 0.1
    STIFFNESS_N_M = 400.0
    DAMPING_N_S_M = 8.0
    PUSH_N = 0.7
    NORMAL_DAMPING_N_S_M = 4.0
    REST_ABOVE_M = 0.010
    REACH_M = 0.015

    def __init__(self, step_s, plane_z_m, explore_s, seed):
        self.step_s = step_s
        self.plane_z_m = plane_z_m
        self.steps_of_exploration = round(explore_s / step_s)
        self.random = random.Random(seed)
        self.position = [0.0, 0.0, plane_z_m + self.REST_ABOVE_M]
        self.velocity = [0.0, 0.0, 0.0]
        self.aim = [0.0, 0.0]
        self.goal = [0.0, 0.0]
        self.speed_m_s = 0.1
        self.steps_left = 0
        self.held = False

    def explore(self):
        self.steps_left = self.steps_of_exploration

    def move_aim(self):
        """Along the stroke; at its end a new one begins."""
        way = [g - a for g, a in zip(self.goal, self.aim)]
        length = math.hypot(*way)
        step = self.speed_m_s * self.step_s
        if length <= step:
            self.goal = [self.random.uniform(-self.REACH_M, self.REACH_M) for _ in range(2)]
            self.speed_m_s = self.random.uniform(0.06, 0.14)
            return [0.0, 0.0]
        self.aim = [a + step * w / length for a, w in zip(self.aim, way)]
        return [self.speed_m_s * w / length for w in way]

    def step(self, force_n):
        if self.held:
            return
        exploring = self.steps_left > 0
        self.steps_left = max(0, self.steps_left - 1)
        aim_velocity = self.move_aim() if exploring else [0.0, 0.0]
        push = [
            self.STIFFNESS_N_M * (self.aim[i] - self.position[i])
            + self.DAMPING_N_S_M * (aim_velocity[i] - self.velocity[i])
            for i in range(2)
        ]
        if exploring:
            push.append(-self.PUSH_N - self.NORMAL_DAMPING_N_S_M * self.velocity[2])
        else:
            rest = self.plane_z_m + self.REST_ABOVE_M
            push.append(
                100.0 * (rest - self.position[2]) - self.DAMPING_N_S_M * self.velocity[2]
            )
        for i in range(3):
            self.velocity[i] += (push[i] + force_n[i]) / self.MASS_KG * self.step_s
            self.position[i] += self.velocity[i] * self.step_s


class Service:
    def __init__(self, options):
        self.options = options
        self.hand = Hand(1.0 / options.hz, options.plane_z, options.explore, options.seed)
        self.calibrated = not options.uncalibrated
        self.power = not options.no_power
        self.gate = 0.3
        self.damping = [0.1, 0.0, 0.0, 0.0]
        self.preset = "defaults"
        self.profile = ""
        self.session = 6
        self.clients = 0
        self.listeners = set()
        self.messages = 0
        self.force = [0.0, 0.0, 0.0]  # of the last message that was understood
        self.largest = 0.0
        self.zeros_last = 0
        self.forces_uncalibrated = 0
        self.full_states = 0
        self.complaints = []

    @property
    def is_new(self):
        return self.options.version == "3.5"

    def complain(self, text):
        if len(self.complaints) < 20:
            self.complaints.append(text)

    # What the service says.

    @staticmethod
    def vec(values):
        return {"x": values[0], "y": values[1], "z": values[2]}

    def centred(self):
        return self.is_new and self.preset == "arm_front_centered"

    def position(self):
        offset = (0.0, 0.0, 0.0) if self.centred() else WORKSPACE_CENTRE_M
        return [p + o for p, o in zip(self.hand.position, offset)]

    def state(self):
        state = {
            "angular_position": {"a0": 0.0, "a1": 45.0, "a2": 90.0},
            "angular_velocity": {"a0": 0.0, "a1": 0.0, "a2": 0.0},
            "body_orientation": {"w": 1.0, "x": 0.0, "y": 0.0, "z": 0.0},
            "cursor_position": self.vec(self.position()),
            "cursor_velocity": self.vec(self.hand.velocity),
        }
        if self.is_new:
            state["current_cursor_force"] = self.vec(self.delivered())
            state["control_domain"] = "cartesian"
            state["control_mode"] = "force"
        else:
            state["mode"] = "force"
        return state

    def status(self, other):
        return {
            "calibrated": self.calibrated,
            "in_use": other,
            "power_supply": self.power,
            "ready": self.power,
            "started": self.power,
        }

    def config(self):
        config = {
            "type": self.options.type,
            "port": "/dev/ttyACM0",
            "device_info": {"major_version": 7, "minor_version": 4, "id": self.options.id},
            "gravity_compensation": {"enabled": True, "scaling_factor": 1.0},
            "handedness": self.options.handedness,
            "torque_scaling": {"enabled": True},
        }
        if self.is_new:
            scale = 0.5 if self.options.hub_scale else 1.0
            config["preset"] = self.preset
            config["basis"] = {"permutation": "XYZ"}
            config["mount"] = {
                "position": self.vec((0.0, 0.0, 0.0)),
                "rotation": {"w": 1, "x": 0, "y": 0, "z": 0},
                "scale": self.vec((scale, scale, scale)),
            }
            config["filters"] = {
                "force_gate": {"gain": self.gate},
                "damping": {"scalar": self.damping[0], "vector": self.vec(self.damping[1:])},
            }
        return config

    def device(self, whole, other=False):
        device = {"device_id": self.options.id, "state": self.state(), "status": self.status(other)}
        if whole:
            device["config"] = self.config()
        return device

    def says(self, whole, other=False):
        devices = [self.device(whole, other)]
        if self.options.twins:
            devices.append(dict(devices[0], device_id="04BB"))
        if self.options.no_device:
            devices = []
        message = {"inverse3": devices, "verse_grip": [], "wireless_verse_grip": []}
        if self.options.grip:
            message["wireless_verse_grip"] = [
                {"device_id": "61548", "state": {"buttons": {"a": True, "b": False, "c": True}}}
            ]
        if self.is_new:
            message["session_id"] = self.session
        return message

    # What a client says.

    def delivered(self):
        """The gate passes the less of a force the higher it is (assumed: a plain factor)."""
        if not self.is_new:
            return self.force
        return [(1.0 - self.gate) * f for f in self.force]

    def configure(self, what):
        if not self.is_new:
            return self.complain("configure: unknown before 3.5")
        if "mount" in what and "preset" in what:
            return self.complain("preset and mount exclude each other")
        for key, value in what.items():
            if key == "preset":
                self.preset = value["preset"]
            elif key == "force_gate":
                if not self.options.gate_on:
                    self.gate = value["gain"]
            elif key == "damping":
                if "scalar" in value:
                    self.damping[0] = value["scalar"]
                if "vector" in value:
                    self.damping[1:] = [value["vector"][axis] for axis in "xyz"]
            else:
                self.complain("configure: " + key)

    def obey(self, message):
        """One message of the client. A command holds for this message alone."""
        whole = False
        self.force = [0.0, 0.0, 0.0]
        for key, value in message.items():
            if key == "session":
                for name, body in value.items():
                    if name == "force_render_full_state":
                        whole = True
                    elif name == "configure" and self.is_new:
                        self.profile = body["profile"]["name"]
                    else:
                        self.complain("session: " + name)
            elif key == "inverse3":
                for device in value:
                    self.obey_for_device(device)
            else:
                self.complain(key)
        self.largest = max(self.largest, math.hypot(*self.force))
        self.zeros_last = self.zeros_last + 1 if self.force == [0.0, 0.0, 0.0] else 0
        if not self.calibrated and self.zeros_last == 0:
            self.forces_uncalibrated += 1
        return whole

    def obey_for_device(self, device):
        if device["device_id"] != self.options.id:
            return self.complain("device " + str(device["device_id"]))
        if "configure" in device:
            self.configure(device["configure"])
        for name, body in device.get("commands", {}).items():
            key = "vector" if self.is_new else "values"
            if name != "set_cursor_force":
                self.complain("command " + name)
            elif list(body) != [key] or sorted(body[key]) != ["x", "y", "z"]:
                self.complain("set_cursor_force: " + ", ".join(body))
            else:
                self.force = [float(body[key][axis]) for axis in "xyz"]

    def garbage(self):
        kind = self.options.garbage
        message = self.says(False)
        device = message["inverse3"][0]
        if kind == "text":
            return ["no JSON at all {"]
        if kind == "far":
            device["state"]["cursor_position"]["z"] = 123.0
        elif kind == "gone":
            message["inverse3"] = []
        elif kind == "twice":
            return [json.dumps(message)] * 2
        elif kind == "huge":
            message["padding"] = "x" * 4_000_000
        return [json.dumps(message)]

    # Connections.

    async def simulation(self, socket, _path="/"):
        other = self.options.other_session or self.clients > 0
        self.clients += 1
        self.session += 1
        self.gate, self.damping, self.preset = 0.3, [0.1, 0.0, 0.0, 0.0], "defaults"
        try:
            await socket.send(json.dumps(self.says(True, other)))
            async for text in socket:
                self.messages += 1
                whole = self.obey(json.loads(text))
                self.full_states += whole
                self.hand.step(self.delivered() if self.power else [0.0, 0.0, 0.0])
                if self.options.silence_after and self.messages > self.options.silence_after:
                    continue
                if self.options.disconnect_after and self.messages > self.options.disconnect_after:
                    break
                if self.options.garbage and self.messages > self.options.garbage_after:
                    for answer in self.garbage():
                        await socket.send(answer)
                else:
                    await socket.send(json.dumps(self.says(whole)))
        except websockets.ConnectionClosed:
            pass
        finally:
            self.clients -= 1
            self.force = [0.0, 0.0, 0.0]

    async def events(self, socket, _path="/"):
        self.listeners.add(socket)
        try:
            async for _ in socket:
                self.complain("the events channel takes no messages")
        finally:
            self.listeners.discard(socket)

    @property
    def http_is_apart(self):
        """Until some version 3.5 HTTP had a port of its own."""
        return self.options.http_apart or not self.is_new

    async def answer_on_simulation(self, path, headers):
        if "Upgrade" in headers or self.http_is_apart:
            return None
        return await self.answer_http(path, headers)

    async def answer_http(self, path, _headers):
        bodies = {
            "/version": {
                "build_time": "2024-08-07T16:01:53Z",
                "git_tag": self.options.version + ".0",
                "project_name": "haply-inverse-service",
                "project_version": self.options.version + ".0.0",
            },
            "/devices": self.says(True),
        }
        if self.is_new:
            sessions = [{"session_id": self.session, "profile": {"name": self.profile}}]
            sessions = sessions[: self.clients]
            if self.options.other_session:
                sessions.append({"session_id": 3, "profile": {"name": "co.haply.hub::demo-orb"}})
            bodies["/sessions"] = {
                "ok": True,
                "data": {"session_count": len(sessions), "sessions": sessions},
            }
            if self.options.home_return != "unknown":
                bodies["/inverse3/" + self.options.id + "/config/home_return"] = {
                    "ok": True,
                    # The form is assumed, after those of torque_scaling and gravity_compensation.
                    "data": {"enabled": self.options.home_return == "on"},
                }
        if self.options.no_version:
            del bodies["/version"]
        if self.options.http_nonsense:
            return http.HTTPStatus.OK, [], b"<html>"
        if path not in bodies:
            return http.HTTPStatus.NOT_FOUND, [], b"{}"
        kind = [("Content-Type", "application/json")]
        return http.HTTPStatus.OK, kind, json.dumps(bodies[path]).encode()

    def report(self):
        return json.dumps(
            {
                "clients": self.clients,
                "complaints": self.complaints,
                "damping": self.damping,
                "force": self.force,
                "forces_uncalibrated": self.forces_uncalibrated,
                "full_states": self.full_states,
                "gate": self.gate,
                "largest": self.largest,
                "listeners": len(self.listeners),
                "messages": self.messages,
                "position": self.hand.position,
                "preset": self.preset,
                "profile": self.profile,
                "zeros_last": self.zeros_last,
            }
        )

    async def take_command(self, line):
        word, _, rest = line.strip().partition(" ")
        if word == "explore":
            self.hand.explore()
        elif word == "calibrate":
            self.calibrated = True
        elif word == "power":
            self.power = rest == "on"
        elif word == "hold":
            self.hand.position, self.hand.velocity = json.loads(rest)
            self.hand.held = True
        elif word == "event":
            for listener in list(self.listeners):
                await listener.send(rest)
            print("sent", flush=True)
        elif word == "report":
            print(self.report(), flush=True)
        else:
            print("unknown command: " + word, flush=True)


def read_options():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", 1)[0])
    parser.add_argument("--port", type=int, default=0, help="0: any free one")
    parser.add_argument("--events-port", type=int, default=0)
    parser.add_argument("--no-events", action="store_true", help="no events channel")
    parser.add_argument("--version", choices=["2.9", "3.1", "3.5", "4.0"], default="3.5")
    parser.add_argument("--type", default="inverse3", help="inverse3, inverse3x or minverse")
    parser.add_argument("--id", default="049D")
    parser.add_argument("--twins", action="store_true", help="a second device, 04BB")
    parser.add_argument("--no-device", action="store_true")
    parser.add_argument("--grip", action="store_true", help="a wireless grip, buttons a and c down")
    parser.add_argument("--no-power", action="store_true")
    parser.add_argument("--uncalibrated", action="store_true")
    parser.add_argument("--gate-on", action="store_true", help="the force gate stays at 0.3")
    parser.add_argument("--hub-scale", action="store_true", help="a workspace scaled by the Hub")
    parser.add_argument("--other-session", action="store_true")
    parser.add_argument("--http-nonsense", action="store_true")
    parser.add_argument("--http-port", type=int, default=0, help="of HTTP, where that is apart")
    parser.add_argument("--http-apart", action="store_true", help="as an early version 3.5")
    parser.add_argument("--no-version", action="store_true", help="/version is not known")
    parser.add_argument("--handedness", choices=["right", "left"], default="right")
    parser.add_argument("--home-return", choices=["on", "off", "unknown"], default="off")
    parser.add_argument("--silence-after", type=int, metavar="MESSAGES", default=0)
    parser.add_argument("--disconnect-after", type=int, metavar="MESSAGES", default=0)
    parser.add_argument(
        "--garbage",
        choices="text far gone twice huge".split(),
        help="what it answers after --garbage-after messages",
    )
    parser.add_argument("--garbage-after", type=int, metavar="MESSAGES", default=100)
    parser.add_argument("--hz", type=float, default=1000.0, help="steps of the hand a second")
    parser.add_argument("--plane-z", type=float, default=-0.010, help="height of the plane, m")
    parser.add_argument("--explore", type=float, default=1.6, help="seconds of an exploration")
    parser.add_argument("--seed", type=int, default=1)
    return parser.parse_args()


def http_hook(answer):
    """`answer(path, headers)` as the installed websockets calls it: from version 14 on with a connection
    and a request, and for a response."""

    async def hook(first, second):
        if isinstance(first, str):
            return await answer(first, second)
        answered = await answer(second.path, second.headers)
        if answered is None:
            return None
        status, headers, body = answered
        response = first.respond(status, body.decode())
        for name, value in headers:
            del response.headers[name]
            response.headers[name] = value
        return response

    return hook


async def main():
    options = read_options()
    service = Service(options)
    simulation = await websockets.serve(
        service.simulation,
        "127.0.0.1",
        options.port,
        process_request=http_hook(service.answer_on_simulation),
        compression=None,
        ping_interval=None,
    )
    ports = [simulation.sockets[0].getsockname()[1], 0, simulation.sockets[0].getsockname()[1]]
    if service.http_is_apart:
        web = await websockets.serve(
            service.events,
            "127.0.0.1",
            options.http_port,
            process_request=http_hook(service.answer_http),
        )
        ports[2] = web.sockets[0].getsockname()[1]
    if not options.no_events:
        events = await websockets.serve(
            service.events, "127.0.0.1", options.events_port, ping_interval=None
        )
        ports[1] = events.sockets[0].getsockname()[1]
    print("ready", *ports, flush=True)
    loop = asyncio.get_running_loop()
    while line := await loop.run_in_executor(None, sys.stdin.readline):
        await service.take_command(line)


if __name__ == "__main__":
    asyncio.run(main())
