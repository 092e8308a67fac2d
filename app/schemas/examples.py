"""Give the examples of robots, logs and mappings for /docs, so that "Try it out" works with the YuMi arm."""

from ...core.robot.builtin import builtin_description

YUMI_LEFT: dict[str, object] = builtin_description("yumi-left")
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
READING = {"mapping": {"torque": {"columns": ["m2", "m1"], "unit": "N m", "scale": [1.0, -1.0]}}}
