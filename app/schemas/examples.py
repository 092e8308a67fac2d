"""Give the examples for /docs, so that "Try it out" works with the YuMi arm.

The ids of the example logs follow from the bytes of the files that ship with the project, uploaded under
their own names; a test keeps them together.
"""

from ...core.robot.builtin import builtin_description

YUMI_LEFT: dict[str, object] = builtin_description("yumi-left")
EXAMPLE_LOG = "examples/yumi/log.csv"
EXAMPLE_LOG_ID = "log-5d5467910a83d6dbb2b0"
JOB_REQUEST: dict[str, object] = {
    "kind": "identify",
    "robot": "yumi-left",
    "logs": [EXAMPLE_LOG_ID],
    "options": {},
}
HIDDEN_LOG = "examples/yumi/hidden_log.csv"
HIDDEN_LOG_ID = "log-a7b55ace1b0dad189dae"
DIAGNOSE_REQUEST: dict[str, object] = {
    "kind": "diagnose",
    "robot": "yumi-left",
    "logs": [HIDDEN_LOG_ID],
    "options": {"reference": None},
}
JOB_REQUESTS: dict[str, object] = {
    "identify": {"summary": "Identify the arm from the first example log", "value": JOB_REQUEST},
    "diagnose": {"summary": "Diagnose the second example log", "value": DIAGNOSE_REQUEST},
}
PENDULUM_URDF = """<robot name="pendulum">
  <link name="base"/>
  <link name="rod">
    <inertial><origin xyz="0 0 -0.5"/><mass value="1"/>
      <inertia ixx="0.02" iyy="0.02" izz="0.001" ixy="0" ixz="0" iyz="0"/></inertial>
  </link>
  <joint name="pivot" type="revolute">
    <parent link="base"/><child link="rod"/><axis xyz="0 1 0"/>
    <limit lower="-3.1" upper="3.1" effort="10" velocity="5"/>
  </joint>
</robot>
"""
CSV_LOG = "time,q_1,tau_1\n0.000,0.1000,0.98\n0.004,0.1004,0.99\n"
MAPPING = (
    '{"time": {"column": "t", "unit": "ms"}, "position": {"columns": ["a1", "a2"], "unit": "deg"}, '
    '"torque": {"columns": ["m1", "m2"], "unit": "N m"}}'
)
