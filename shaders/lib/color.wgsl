// Twin of src/kernel/color.rs.
