<!DOCTYPE qgis PUBLIC 'http://mrcc.com/qgis.dtd' 'SYSTEM'>
<qgis styleCategories="Symbology|Symbology3D" version="3.40.0" sync3DRendererTo2DRenderer="1">
  <renderer type="ramp" attribute="OptimalKNN" min="10" max="100" pointSize="0.8" pointSizeUnit="MM" pointSizeMapUnitScale="3x:0,0,0,0,0,0" maximumScreenError="0.3" maximumScreenErrorUnit="MM" pointSymbol="1" drawOrder2d="1" renderAsTriangles="0" horizontalTriangleFilter="0" horizontalTriangleFilterThreshold="5" horizontalTriangleFilterUnit="MM">
    <colorrampshader colorRampType="INTERPOLATED" classificationMode="1" minimumValue="10" maximumValue="100" clip="0" labelPrecision="3">
      <colorramp type="gradient" name="[source]">
        <Option type="Map">
          <Option type="QString" name="color1" value="253,231,37,255"/>
          <Option type="QString" name="color2" value="68,1,84,255"/>
          <Option type="QString" name="discrete" value="0"/>
          <Option type="QString" name="rampType" value="gradient"/>
          <Option type="QString" name="stops" value="0.25;94,201,98,255;rgb;ccw:0.5;33,145,140,255;rgb;ccw:0.75;59,82,139,255;rgb;ccw"/>
        </Option>
      </colorramp>
      <item value="10" label="10 or less" color="#fde725" alpha="255"/>
      <item value="32.5" label="32" color="#5ec962" alpha="255"/>
      <item value="55" label="55" color="#21918c" alpha="255"/>
      <item value="77.5" label="78" color="#3b528b" alpha="255"/>
      <item value="100" label="100 or more" color="#440154" alpha="255"/>
    </colorrampshader>
  </renderer>
  <blendMode>0</blendMode>
</qgis>
